#pragma once

#include "cmm/grid.h"
#include "core/pose.h"

namespace rondure::plans {

/// Poses sent to and read from a fixture lie on a grid of 1e-10 deg, so that a turn sent as
/// directions in a line of I++ DME is equal to the last bit to a turn inside the program.
[[nodiscard]] inline core::Pose on_grid(const core::Pose& pose) {
  return {cmm::angle_on_grid(pose.alpha_rad), cmm::angle_on_grid(pose.beta_rad)};
}

}  // namespace rondure::plans
