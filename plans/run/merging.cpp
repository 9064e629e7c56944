// Clouds from several poses: the part of inspection.h that measures the reachable targets.

#include "core/units.h"
#include "fit/references/min_zone_cylinder.h"
#include "plans/checks/internal/merged_reach.h"
#include "plans/run/internal/inspection.h"

namespace rondure::plans {

core::Result<Cloud> FeatureSession::measure_reachable(const core::Pose& commanded) {
  if (!merging()) all_targets_ = targets_;
  targets_ =
      planner_.reachable(all_targets_, geometry_,
                         fixture::body_to_machine(context_.cell->kinematics(), commanded), X_BP_);
  if (targets_.size() < kLeastTargets) {
    return core::fail(core::Code::kUnreachable, too_few_targets(commanded, targets_.size()));
  }
  return measure(commanded);
}

void FeatureSession::keep_merged_truth() {
  const auto X_WB = context_.cell->true_body_to_machine();
  if (!X_WB) return;
  for (const Eigen::Vector3d& tip : truth_) merged_truth_B_.emplace_back(X_WB->inverse() * tip);
}

core::Result<void> FeatureSession::end_merged() {
  if (merged_truth_B_.empty() || context_.recorded.truths_of(index_) > 0) return {};
  const auto zone = fit::min_zone_cylinder(merged_truth_B_, Eigen::Vector3d::UnitZ());
  if (!zone) return {};  // only a comparison: the run continues
  return context_.journal.add(record::SimulationTruth{index_, zone->width_mm()});
}

}  // namespace rondure::plans
