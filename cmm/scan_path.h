#pragma once

#include <string>

#include <Eigen/Core>

#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm {

/// Checks a scan command before it is sent (kMachine): not finite, no axis, a start on the axis,
/// too many points. Only the command is checked.
[[nodiscard]] core::Result<void> check_scan(const ScanCircleCommand& command);

/// The touch that finds the surface at point `index` of a scan, 0..points; `points` is the end of
/// the sweep. Its direction is radial, and its id is that of the point.
[[nodiscard]] TouchCommand scan_point(const ScanCircleCommand& command, int index);

/// The touch at an angle from the start [rad], about the axis of the circle.
[[nodiscard]] TouchCommand scan_point_at(const ScanCircleCommand& command, double angle_rad,
                                         int index);

/// Angle of a position from the start, about the axis of the circle [rad], in -pi..pi.
[[nodiscard]] double scan_angle(const ScanCircleCommand& command, const Eigen::Vector3d& p_W_mm);

/// Length of the expected path of the tip centre [mm].
[[nodiscard]] double scan_length_mm(const ScanCircleCommand& command);

/// "(1.000, -2.500, 30.000) mm", for messages.
[[nodiscard]] std::string in_words(const Eigen::Vector3d& p_mm);

}  // namespace rondure::cmm
