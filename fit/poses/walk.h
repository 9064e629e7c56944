#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/pose.h"
#include "core/result.h"

namespace rondure::fit {

/// Returns f in a pose: the least zone with the axis held parallel to machine z [mm]. kPoseRange
/// means that the fixture cannot take the pose, which is skipped; any other error ends the walk.
using PoseFunction = std::function<core::Result<double>(const core::Pose&)>;

/// One pose that a walk evaluated.
struct PoseStep {
  core::Pose pose;
  double f_mm = 0.0;
  double step_deg = 0.0;  ///< Step of the walk when it reached this pose.
};

/// Course and end of a walk.
struct PoseWalk {
  std::vector<PoseStep> visited;  ///< In order, each pose once.
  std::size_t best = 0;           ///< Index of the final, best pose in `visited`.
};

/// Pose search [401-402]. Evaluates the eight neighbours of the current pose at the current step
/// and moves to the one with the least f, until no neighbour is better by more than 1e-9 mm; then
/// continues with the next step. It ends after the last step.
///
/// @param steps_deg  Steps in order, each > 0.
/// @return kPoseRange if the fixture cannot take the start, or the error that ended the walk.
/// Source: methods, cylindricity section 10.1.
[[nodiscard]] core::Result<PoseWalk> walk_poses(const PoseFunction& f, const core::Pose& start,
                                                std::span<const double> steps_deg);

/// Returns the given steps, followed by halves of the last one down to `least_deg`.
[[nodiscard]] std::vector<double> halved_steps(std::span<const double> steps_deg, double least_deg);

}  // namespace rondure::fit
