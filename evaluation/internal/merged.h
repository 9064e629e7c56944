#pragma once

#include <optional>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/merged_poses.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The touches of all poses of a feature of the strategy "merged", in one body frame.
struct MergedCloud {
  std::vector<CloudPoint> points;  ///< One for each pose and target reached in it.
  MergedPoses merged;
  std::optional<double> sigma_mm;  ///< Pooled standard deviation of a single touch.
  std::optional<Temperatures> temperatures;
};

/// Transforms the touches of each pose to the body frame with the inverse of the fixture's motion
/// and, if the plan asks for it, with the pose errors that fit::pose_joint() finds.
/// @return kNoPoints when not all poses were measured; for a joint merge the errors of
///         pose_joint().
/// Source: methods, cylindricity section 3.2 and rotary axes section 8.
[[nodiscard]] core::Result<MergedCloud> merged_cloud(const record::RunRecord& record, int feature,
                                                     const std::optional<fit::ProbeTip>& probe);

}  // namespace rondure::evaluation
