#pragma once

#include <string>
#include <vector>

#include "core/pose.h"
#include "plans/path/internal/cloud_path.h"

namespace rondure::plans {

/// All targets of a feature that the tool cannot reach in a pose, before the part is located, with
/// the part at the position stated in the plan. Ignores the order of touches: one check per target.
/// @param detour_moves  As CloudPath.
[[nodiscard]] std::vector<Unreachable> unreachable_targets(
    const Plan& plan, const FeaturePlan& feature, const core::Pose& pose,
    std::size_t detour_moves = CloudPath::kDetourMoves);

/// Suggests a change that makes all targets of such a feature reachable: another start pose, a
/// longer stylus (with its length), a larger margin or fewer layers. Each suggestion was tried and
/// reaches all targets; "no other pose, stylus or margin that was tried reaches it" if none does.
/// Tries nothing beyond 500 targets.
[[nodiscard]] std::string reach_advice(const Plan& plan, const FeaturePlan& feature);

}  // namespace rondure::plans
