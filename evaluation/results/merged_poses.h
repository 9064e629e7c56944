#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/error.h"
#include "core/pose.h"
#include "fit/poses/joint.h"

// A cloud that several poses of the fixture make, and what the fixture adds to it.

namespace rondure::evaluation {

/// How the clouds of several poses became one.
struct MergedPoses {
  bool joint = false;               ///< The errors of the poses were solved for and taken out.
  std::vector<core::Pose> poses;    ///< As the fixture read them, in the order measured.
  std::vector<std::size_t> points;  ///< Targets touched in each.
  double touch_mm = 0.0;            ///< Standard uncertainty of the mean touches of a target.
  /// Part and poses solved together; with the merge by kinematics for what the fixture may add
  /// only. Nothing: `refusal` says why.
  std::optional<fit::PoseJoint> solved;
  std::optional<core::Error> refusal;
};

}  // namespace rondure::evaluation
