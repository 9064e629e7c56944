#pragma once

#include <string>
#include <vector>

#include "core/pose.h"
#include "plans/path/internal/cloud_path.h"

namespace rondure::plans {

/// Every target of a feature that the tool cannot reach in a pose, before the part is located and
/// where the plan says it is. Without an order of touches: one look a target.
[[nodiscard]] std::vector<Unreachable> unreachable_targets(const Plan& plan,
                                                           const FeaturePlan& feature,
                                                           const core::Pose& pose);

/// What would bring all targets of such a feature within reach: another start pose, a longer stylus
/// (how long), a larger margin or fewer layers. Each was tried and reaches all targets; "no other
/// pose, stylus or margin that was tried reaches it" when none does. Up to 500 targets, beyond
/// which nothing is tried.
[[nodiscard]] std::string reach_advice(const Plan& plan, const FeaturePlan& feature);

}  // namespace rondure::plans
