#pragma once

#include <Eigen/Core>

#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm {

/// Where the tip has to stand before a touch begins.
[[nodiscard]] Eigen::Vector3d start_of(const TouchCommand& command);

/// Why a touch cannot be commanded (kMachine): not finite, a direction that is no unit vector, a
/// search that ends before it starts, or a tip that does not stand at its start to 1e-6 mm.
[[nodiscard]] core::Result<void> check_touch(const TouchCommand& command,
                                             const Eigen::Vector3d& position_W_mm);

}  // namespace rondure::cmm
