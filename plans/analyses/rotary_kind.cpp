#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/units.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/rotary_plan.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;

constexpr std::array kRotaryForms = {record::Form::kFixtureResidual,
                                     record::Form::kFixtureResidualRms, record::Form::kAxisError};
constexpr std::size_t kLeastPoses = 5;

void check_verification(const record::RotaryTask& plan, const std::string& where,
                        Findings& findings) {
  if (!findings.sound(where)) return;
  for (std::size_t i = 0; i < plan.verification.size(); ++i) {
    const record::CombinedPoseTask& pose = plan.verification[i];
    if (pose.alpha_deg != 0.0 && pose.beta_deg != 0.0) continue;
    findings.meaning(Code::kMeaning, item_pointer(where, i),
                     "an axis stands at 0, as at the stations; verify in poses of both axes");
  }
  if (plan.verification.size() < kLeastPoses) {
    findings.meaning(Code::kTooFewPoints, where,
                     fmt::format("{} poses do not verify a calibration; at least {} are needed",
                                 plan.verification.size(), kLeastPoses));
  }
}

void check_balls(const record::RotaryTask& plan, const std::string& where, Findings& findings) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < plan.balls.size(); ++i) {
    const std::string place = item_pointer(where, i);
    if (findings.sound(place)) check_ball_id(plan.balls[i].id, seen, place, findings);
  }
}

void check_rotary_axes(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const record::RotaryTask& plan = *feature.rotary_axes;
  check_balls(plan, where + "/balls", findings);
  check_axis_stations(plan.alpha_stations_deg, "the zero pose", where + "/alpha_stations_deg",
                      findings);
  check_axis_stations(plan.beta_stations_deg, "the zero pose", where + "/beta_stations_deg",
                      findings);
  check_verification(plan, where + "/verification", findings);
}

void check_travel(const std::vector<double>& angles_deg, double min_deg, double max_deg,
                  const std::string& where, Findings& findings) {
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    if (angles_deg[i] >= min_deg && angles_deg[i] <= max_deg) continue;
    findings.meaning(Code::kPoseRange, item_pointer(where, i),
                     fmt::format("{} deg is outside the travel {}..{} deg of the fixture",
                                 plain(angles_deg[i]), plain(min_deg), plain(max_deg)));
  }
}

void check_angles(const record::RotaryTask& plan, const FixturePlan& fixture,
                  const std::string& where, Findings& findings) {
  check_travel(plan.alpha_stations_deg, fixture.min_alpha_deg, fixture.max_alpha_deg,
               where + "/alpha_stations_deg", findings);
  check_travel(plan.beta_stations_deg, fixture.min_beta_deg, fixture.max_beta_deg,
               where + "/beta_stations_deg", findings);
  const auto range = [](const std::vector<double>& stations) {
    const auto [low, high] = std::minmax_element(stations.begin(), stations.end());
    return std::pair(std::min(0.0, *low), std::max(0.0, *high));
  };
  const auto [alpha_low, alpha_high] = range(plan.alpha_stations_deg);
  const auto [beta_low, beta_high] = range(plan.beta_stations_deg);
  for (std::size_t i = 0; i < plan.verification.size(); ++i) {
    const record::CombinedPoseTask& p = plan.verification[i];
    if (p.alpha_deg >= alpha_low && p.alpha_deg <= alpha_high && p.beta_deg >= beta_low &&
        p.beta_deg <= beta_high) {
      continue;
    }
    findings.meaning(Code::kPoseRange, item_pointer(where + "/verification", i),
                     fmt::format("({}, {}) deg lies beyond the stations, where nothing is known of "
                                 "the errors; add stations, or verify within them",
                                 plain(p.alpha_deg), plain(p.beta_deg)));
  }
}

void check_cell(const Plan& plan, std::size_t index, Findings& findings) {
  const std::string where = feature_pointer(index);
  if (findings.is_given(where + "/source")) {
    findings.meaning(Code::kMeaning, where + "/source",
                     "has no effect: balls are touched; balls of a file are evaluated by \"rondure "
                     "fit rotary-axes\"; remove it");
  }
  if (!plan.fixture) return;  // check_equipment() reports this
  if (is_fixed(plan)) {
    findings.meaning(Code::kMeaning, where + "/type",
                     "the fixture is \"fixed\": it has no axes to calibrate; remove the feature, "
                     "or say which fixture turns the balls");
    return;
  }
  if (plan.fixture->id.empty() && findings.sound("/fixture/id")) {
    findings.meaning(Code::kMissingKey, "/fixture/id",
                     "this key is missing: what the fixture is called; its calibration belongs to "
                     "no other");
  }
  const bool joined = findings.is_given("/fixture/calibration/feature");
  if (findings.is_given("/fixture/calibration") && !joined) {
    findings.meaning(Code::kMeaning, "/fixture/calibration",
                     "a run that calibrates the fixture does not use another calibration; remove "
                     "it, or name in fixture.calibration.feature the feature that calibrates");
  }
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    if (joined || !is_touched(plan.features[i])) continue;
    findings.meaning(
        Code::kMeaning, feature_pointer(i),
        fmt::format("{} would be measured in the fixture that this plan calibrates, and judged as "
                    "if that fixture had no errors; calibrate first and join both with "
                    "fixture.calibration: {{\"feature\": {}}}, or calibrate with a plan of its own",
                    in_quotes(plan.features[i].id), in_quotes(plan.features[index].id)));
  }
  if (findings.is_given("/fixture/datum")) {
    findings.meaning(Code::kMeaning, "/fixture/datum",
                     "a run that calibrates the fixture takes the machine frame as its base; "
                     "remove it");
  }
  const std::string section = where + "/rotary_axes";
  const auto& rotary = plan.features[index].rotary_axes;
  if (!rotary || !findings.sound(section) || !findings.sound("/fixture")) return;
  if (!rotary->alpha_stations_deg.empty() && !rotary->beta_stations_deg.empty()) {
    check_angles(*rotary, *plan.fixture, section, findings);
  }
  if (auto held = check_zero_is_held(plan, index, plan.fixture->resolution_deg * core::kDegree);
      !held) {
    findings.meaning(held.error().code, held.error().where, held.error().what);
  }
}

}  // namespace

void check_axis_stations(const std::vector<double>& stations_deg, std::string_view zero,
                         const std::string& where, Findings& findings) {
  constexpr std::size_t kLeastStations = 3;  // with 0 four, as a cubic needs
  if (!findings.sound(where)) return;
  std::set<double> seen;
  for (std::size_t i = 0; i < stations_deg.size(); ++i) {
    if (seen.insert(stations_deg[i]).second) continue;
    findings.meaning(
        Code::kMeaning, item_pointer(where, i),
        fmt::format("the station {} deg stands here twice; remove one", plain(stations_deg[i])));
  }
  seen.erase(0.0);
  if (seen.size() >= kLeastStations) return;
  findings.meaning(Code::kTooFewPoints, where,
                   fmt::format("{} stations beside {} do not show how the errors change; at least "
                               "{} are needed, 15 deg apart is usual",
                               seen.size(), zero, kLeastStations));
}

void check_ball_id(const std::string& id, std::set<std::string>& seen, const std::string& where,
                   Findings& findings) {
  if (seen.insert(id).second) return;
  findings.meaning(Code::kMeaning, where + "/id",
                   fmt::format("two balls are called {}; choose another", in_quotes(id)));
}

const AnalysisKind& rotary_kind() {
  static const AnalysisKind kind = {
      .type = "rotary_axes",
      .shape = record::Shape::kRotaryAxes,
      .forms = kRotaryForms,
      .is_simulated = nullptr,
      .settings = settings_of_section<&FeaturePlan::rotary_axes>,
      .files = [](const FeaturePlan&) { return std::vector<SeriesFile>{}; },
      .check = check_rotary_axes,
      .simulate = nullptr,
      .check_cell = check_cell};
  return kind;
}

}  // namespace rondure::plans
