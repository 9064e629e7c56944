#pragma once

#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm {

/// Why a scan cannot be commanded (kMachine): not finite, no axis, a start on the axis, too many
/// points. Only the command is looked at.
[[nodiscard]] core::Result<void> check_scan(const ScanCircleCommand& command);

/// The touch that finds the surface at point `index` of a scan, 0..points; `points` is the end of
/// the sweep. Its direction points along the radius, its number is that of the point.
[[nodiscard]] TouchCommand scan_point(const ScanCircleCommand& command, int index);

/// Length of the expected path of the tip centre [mm].
[[nodiscard]] double scan_length_mm(const ScanCircleCommand& command);

}  // namespace rondure::cmm
