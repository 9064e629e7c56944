#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/pose.h"
#include "core/result.h"

namespace rondure::fit {

/// f in a pose: the least zone with the axis held parallel to machine z [mm]. kPoseRange says that
/// the pose cannot be taken and is passed over; any other error ends the walk.
using PoseFunction = std::function<core::Result<double>(const core::Pose&)>;

/// One pose a walk evaluated.
struct PoseStep {
  core::Pose pose;
  double f_mm = 0.0;
  double step_deg = 0.0;  ///< Step of the walk when it came here.
};

/// Course and end of a walk.
struct PoseWalk {
  std::vector<PoseStep> visited;  ///< In order, each pose once.
  std::size_t best = 0;           ///< Index of the pose where the walk stands.
};

/// Pose search [401-402]: around the current pose the eight neighbours at the current step are
/// evaluated; the walk moves to the least and repeats; when the centre is the least, the next step
/// follows. Gains of 1e-9 mm and less count as "the centre is the least".
///
/// @param steps_deg  Steps in order, each > 0.
/// @return kPoseRange when the start itself cannot be taken, or the error that ended the walk.
/// Source: methods, cylindricity section 10.1.
[[nodiscard]] core::Result<PoseWalk> walk_poses(const PoseFunction& f, const core::Pose& start,
                                                std::span<const double> steps_deg);

/// The published steps, then halves of the last one down to `least_deg`.
[[nodiscard]] std::vector<double> halved_steps(std::span<const double> steps_deg, double least_deg);

}  // namespace rondure::fit
