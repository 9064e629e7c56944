#pragma once

#include "cmm/grid.h"
#include "core/pose.h"

namespace rondure::plans {

/// Poses go to a fixture and come from it on a grid of 1e-10 deg, so that a turn that travels as
/// the directions of a line of I++ DME is the same to the last bit as one inside the program.
[[nodiscard]] inline core::Pose on_grid(const core::Pose& pose) {
  return {cmm::angle_on_grid(pose.alpha_rad), cmm::angle_on_grid(pose.beta_rad)};
}

}  // namespace rondure::plans
