#include <string>

#include <fmt/format.h>

#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_checks.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

void check_start(double start_deg, double min_deg, double max_deg, const std::string& where,
                 Findings& findings, const char* word = "start angle") {
  if (min_deg >= max_deg || !findings.is_given(where) ||
      (start_deg >= min_deg && start_deg <= max_deg))
    return;
  findings.meaning(Code::kPoseRange, where,
                   fmt::format("{} {} deg is outside {}..{} deg, the travel of the fixture", word,
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

/// Checks the requirements of a cloud from several poses, and the current limitations of merging.
void check_merged(const Plan& plan, const FeaturePlan& feature, const std::string& feature_where,
                  Findings& findings) {
  const std::string where = feature_where + "/pose_search";
  const FixturePlan& fixture = *plan.fixture;
  const auto& poses = feature.pose_search.poses;
  const auto refuse = [&](const std::string& place, std::string what) {
    findings.meaning(Code::kMeaning, place, std::move(what));
  };
  if (feature.type != record::Shape::kCylinder)
    return refuse(where + "/strategy",
                  fmt::format("\"merged\" is of a cylinder; a {} is measured in one pose",
                              name_of(feature.type)));
  if (feature.sampling.method == record::SamplingMethod::kScan) {
    refuse(
        feature_where + "/sampling/method",
        "in several poses points are touched, not scanned: which of them a pose reaches differs");
  }
  if (poses.size() < 2) {
    refuse(where + "/poses",
           fmt::format("\"merged\" needs at least 2 poses, {} are given", poses.size()));
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const std::string place = item_pointer(where + "/poses", k);
    check_start(poses[k].alpha_deg, fixture.min_alpha_deg, fixture.max_alpha_deg,
                place + "/alpha_deg", findings, "angle");
    check_start(poses[k].beta_deg, fixture.min_beta_deg, fixture.max_beta_deg, place + "/beta_deg",
                findings, "angle");
  }
  const bool stated = plan.uncertainty && plan.uncertainty->fixture &&
                      plan.uncertainty->fixture->position_um > 0.0 &&
                      plan.uncertainty->fixture->angle_deg > 0.0;
  if (feature.pose_search.merge == record::Merge::kJoint && !stated) {
    findings.meaning(Code::kMissingKey, "/uncertainty/fixture",
                     "poses are solved jointly against what the fixture is believed to do: give "
                     "position_um and angle_deg, both above 0, or merge by \"kinematics\"");
  }
  if (fixture.datum) {
    refuse("/fixture/datum",
           "merged poses are evaluated with axis_point_mm in the machine frame; leave the spheres "
           "out");
  }
  if (plan.part.expansion_per_K || plan.machine->scale_expansion_per_K) {
    refuse(plan.part.expansion_per_K ? "/part/expansion_per_K" : "/machine/scale_expansion_per_K",
           "merged poses are evaluated as measured; leave the expansion out and keep 20 degC");
  }
}

}  // namespace

void check_pose_search(const Plan& plan, std::size_t index, Findings& findings) {
  const FeaturePlan& feature = plan.features[index];
  const std::string where = feature_pointer(index) + "/pose_search";
  if (!plan.fixture || !findings.sound("/fixture") || !findings.sound(where)) return;
  if (is_fixed(plan)) return;  // check_fixed_part()
  const FixturePlan& fixture = *plan.fixture;
  const PoseSearchPlan& search = feature.pose_search;
  check_start(search.start_alpha_deg, fixture.min_alpha_deg, fixture.max_alpha_deg,
              where + "/start_alpha_deg", findings);
  check_start(search.start_beta_deg, fixture.min_beta_deg, fixture.max_beta_deg,
              where + "/start_beta_deg", findings);
  if (search.strategy == record::Strategy::kMerged) {
    if (plan.machine) check_merged(plan, feature, feature_pointer(index), findings);
    return;
  }
  if (!search.poses.empty()) {
    findings.meaning(Code::kMeaning, where + "/poses",
                     fmt::format("these poses are of the strategy \"merged\", the strategy is "
                                 "\"{}\"; leave them out or change it",
                                 name_of(search.strategy)));
  }
  if (feature.type != record::Shape::kCylinder || search.strategy != record::Strategy::kAsPublished)
    return;
  for (std::size_t i = 0; i < search.steps_deg.size(); ++i) {
    check_fineness(search.steps_deg[i], fixture.resolution_deg,
                   item_pointer(where + "/steps_deg", i), findings);
  }
}

}  // namespace rondure::plans
