#pragma once

#include <cstddef>
#include <string>

#include "core/pose.h"
#include "core/result.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Least number of reachable targets in a pose of a merged cloud: a cylinder determines four
/// parameters of the pose.
inline constexpr std::size_t kLeastTargets = 4;

/// "pose (60, 0) deg: 2 targets can be reached, at least 4 are needed".
[[nodiscard]] std::string too_few_targets(const core::Pose& pose, std::size_t reached);

/// Checks a feature of the strategy "merged", with the part at the position stated in the plan:
/// every pose reaches kLeastTargets, and every target is reached in one of the poses.
/// @return kUnreachable with the pointer of the key to change, and the missing targets. Nothing
///         moves.
[[nodiscard]] core::Result<void> check_merged_reach(const Plan& plan, std::size_t index);

}  // namespace rondure::plans
