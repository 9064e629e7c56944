#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/error.h"
#include "core/pose.h"
#include "fit/poses/joint.h"

// A cloud from several poses of the fixture, and the fixture's contribution to its errors.

namespace rondure::evaluation {

/// Combination of the clouds of several poses.
struct MergedPoses {
  bool joint = false;             ///< The errors of the poses were solved for and removed.
  std::vector<core::Pose> poses;  ///< As read from the fixture, in the order measured.
  /// Body frame in the machine in each pose, by which a merge by kinematics combined the touches.
  std::vector<Eigen::Isometry3d> frames;
  std::vector<std::size_t> points;  ///< Number of targets touched in each pose.
  double touch_mm = 0.0;            ///< Standard uncertainty of the mean touches of a target.
  /// Joint solution of part and poses; for a merge by kinematics only to estimate the fixture's
  /// contribution. None: `refusal` gives the reason.
  std::optional<fit::PoseJoint> solved;
  std::optional<core::Error> refusal;
};

}  // namespace rondure::evaluation
