#include <string>
#include <string_view>

#include <fmt/format.h>

#include "plans/json_text.h"
#include "plans/plan_checks.h"

namespace rondure::plans {
namespace {

using core::Code;

void check_start(double start_deg, double min_deg, double max_deg, const std::string& where,
                 Findings& findings) {
  if (min_deg >= max_deg || !findings.is_given(where) ||
      (start_deg >= min_deg && start_deg <= max_deg))
    return;
  findings.meaning(
      Code::kPoseRange, where,
      fmt::format("start angle {} deg is outside {}..{} deg, the travel of the fixture",
                  plain(start_deg), plain(min_deg), plain(max_deg)));
}

void check_fineness(double step_deg, double resolution_deg, const std::string& where,
                    Findings& findings) {
  if (step_deg >= resolution_deg) return;
  findings.meaning(
      Code::kStep, where,
      fmt::format("a step of {} deg is finer than the fixture can hold, {} deg; take a "
                  "larger step or the strategy \"virtual\"",
                  plain(step_deg), plain(resolution_deg)));
}

}  // namespace

void check_pose_search(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index) + "/pose_search";
  if (!plan.fixture || !findings.sound("/fixture") || !findings.sound(where)) return;
  const FixturePlan& fixture = *plan.fixture;
  const PoseSearchPlan& search = feature.pose_search;
  check_start(search.start_alpha_deg, fixture.min_alpha_deg, fixture.max_alpha_deg,
              where + "/start_alpha_deg", findings);
  check_start(search.start_beta_deg, fixture.min_beta_deg, fixture.max_beta_deg,
              where + "/start_beta_deg", findings);
  const bool refined = search.strategy == "refined";
  if (feature.type == "circle" || (!refined && search.strategy != "as-published")) return;
  for (std::size_t i = 0; i < search.steps_deg.size(); ++i) {
    check_fineness(search.steps_deg[i], fixture.resolution_deg,
                   item_pointer(where + "/steps_deg", i), findings);
  }
  if (refined)
    check_fineness(search.min_step_deg, fixture.resolution_deg, where + "/min_step_deg", findings);
}

}  // namespace rondure::plans
