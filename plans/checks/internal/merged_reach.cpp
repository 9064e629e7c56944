#include "plans/checks/internal/merged_reach.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/checks/internal/reach_advice.h"
#include "plans/path/internal/feature_planner.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/sampling.h"

namespace rondure::plans {
std::string too_few_targets(const core::Pose& pose, std::size_t reached) {
  return fmt::format("pose ({:g}, {:g}) deg: {} targets can be reached, at least {} are needed",
                     pose.alpha_rad / core::kDegree, pose.beta_rad / core::kDegree, reached,
                     kLeastTargets);
}

core::Result<void> check_merged_reach(const Plan& plan, std::size_t index) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = fmt::format("/features/{}", index);
  const auto targets = sampling_targets(feature);
  if (!targets) return core::fail(targets.error().at(where + "/sampling"));
  std::vector<Unreachable> never;  // unreachable in every pose so far, with the last reason
  for (std::size_t k = 0; k < feature.pose_search.poses.size(); ++k) {
    const MeasuringPosePlan& at = feature.pose_search.poses[k];
    const core::Pose pose{at.alpha_deg * core::kDegree, at.beta_deg * core::kDegree};
    std::vector<Unreachable> missed = unreachable_targets(plan, feature, pose);
    if (targets->size() - missed.size() < kLeastTargets) {
      return core::fail(core::Code::kUnreachable,
                        too_few_targets(pose, targets->size() - missed.size()),
                        fmt::format("{}/pose_search/poses/{}", where, k));
    }
    if (k > 0) {
      std::erase_if(missed, [&](const Unreachable& now) {
        return std::none_of(never.begin(), never.end(),
                            [&](const Unreachable& before) { return before.target == now.target; });
      });
    }
    never = std::move(missed);
  }
  if (never.empty()) return {};
  return core::fail(core::Code::kUnreachable,
                    fmt::format("{} of {} targets can be reached in none of the poses; the first: "
                                "{}; add a pose, or keep the layers off the clamp",
                                never.size(), targets->size(), in_words(never.front())),
                    where + "/pose_search/poses");
}

}  // namespace rondure::plans
