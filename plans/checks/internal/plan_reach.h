#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/pose.h"
#include "core/result.h"
#include "plans/path/internal/cloud_path.h"
#include "plans/path/sampling.h"
#include "plans/plan.h"

namespace rondure::plans {

/// The targets of a touched feature, if the tool can reach all of them in the start pose, with the
/// part at the position stated in the plan.
/// @return kSampling or kUnreachable with the pointer of the feature's sampling; names the first
///         unreachable target, the number of others, the cause and the remedy. Nothing moves.
[[nodiscard]] core::Result<std::vector<Target>> reachable_targets(const Plan& plan,
                                                                  std::size_t index);

/// Checks for all features together that the park height clears the part in every pose and the
/// reference sphere, and that the sphere is outside the space that the fixture sweeps.
/// @return kUnreachable with the pointer of the key to change.
[[nodiscard]] core::Result<void> check_room(const Plan& plan);
/// The same for a part that stands still.
/// @param X_WP  Where it stands.
[[nodiscard]] core::Result<void> check_room_at(const Plan& plan, const Eigen::Isometry3d& X_WP);

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
