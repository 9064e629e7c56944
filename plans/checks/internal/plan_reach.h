#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
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

}  // namespace rondure::plans
