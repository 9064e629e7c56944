#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "fit/rotary/ball_setup.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/five_axis_plan.h"
#include "plans/schema/internal/setting_list.h"
#include "plans/schema/json_text.h"

namespace rondure::plans {
namespace {

using core::Code;
using record::FiveAxisTask;

constexpr std::array kHeadForms = {record::Form::kLeftRms, record::Form::kLeftLargest,
                                   record::Form::kLocation, record::Form::kAxisError};
constexpr std::array<record::WantedColumn, 8> kNestColumns = {{{"step", true, kHeadSteps},
                                                               {"c_deg"},
                                                               {"a_deg"},
                                                               {"setup"},
                                                               {"dx_um"},
                                                               {"dy_um"},
                                                               {"dz_um"},
                                                               {"u_um", false}}};
constexpr std::size_t kHeadPoses = 5;
constexpr double kLeastAngle_deg = 5.0;

void check_balls(const FiveAxisTask& plan, const std::string& where, Findings& findings) {
  if (!findings.sound(where)) return;
  std::set<std::string> seen;
  std::vector<Eigen::Vector3d> places;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < plan.balls.size(); ++i) {
    const record::HeadBallTask& ball = plan.balls[i];
    const std::string place = item_pointer(where, i);
    check_ball_id(ball.id, seen, place, findings);
    const bool centre = findings.is_given(place + "/center_mm");
    if (ball.l_mm.has_value() != ball.h_mm.has_value() || centre == ball.l_mm.has_value()) {
      findings.meaning(Code::kMeaning, place,
                       "a ball stands at center_mm, or at L_mm and H_mm, (0, H, -L); give one");
      return;
    }
    places.emplace_back(Eigen::Vector3d::Map(ball.place_mm().data()));
    names.push_back(ball.id);
  }
  if (const auto fine = fit::check_setup(places, names); !fine) {
    findings.meaning(fine.error().code, where, fine.error().what);
  }
}

bool is_on(const std::vector<double>& stations_deg, double deg) {
  return std::ranges::find(stations_deg, deg) != stations_deg.end();
}

bool on_grid(double deg, double step_deg) { return std::abs(std::remainder(deg, step_deg)) < 1e-9; }

void check_verification(const FiveAxisTask& plan, const std::string& where, Findings& findings) {
  if (!findings.sound(where)) return;
  const auto [low, high] = plan.a_stations_deg.empty()
                               ? std::ranges::min_max_result<double>{0.0, 0.0}
                               : std::ranges::minmax(plan.a_stations_deg);
  for (std::size_t i = 0; i < plan.verification.size(); ++i) {
    const record::HeadPoseTask& pose = plan.verification[i];
    const auto refuse = [&](Code code, std::string why) {
      findings.meaning(code, item_pointer(where, i), std::move(why));
    };
    if (std::min(std::abs(pose.c_deg), std::abs(pose.a_deg)) < kLeastAngle_deg) {
      refuse(Code::kMeaning,
             fmt::format("({}, {}) deg: one axis stands near 0, as at the stations; turn both by "
                         "at least {} deg",
                         plain(pose.c_deg), plain(pose.a_deg), plain(kLeastAngle_deg)));
    } else if (is_on(plan.c_stations_deg, pose.c_deg) || is_on(plan.a_stations_deg, pose.a_deg)) {
      refuse(Code::kMeaning, fmt::format("({}, {}) deg: an angle is a station, where the error was "
                                         "read; choose one between the stations",
                                         plain(pose.c_deg), plain(pose.a_deg)));
    } else if (on_grid(pose.c_deg, plan.compensation.c_step_deg) &&
               on_grid(pose.a_deg, plan.compensation.a_step_deg)) {
      refuse(Code::kMeaning,
             fmt::format("({}, {}) deg is a point of the table, which does not show what is "
                         "between its points; choose another",
                         plain(pose.c_deg), plain(pose.a_deg)));
    } else if (pose.a_deg < std::min(0.0, low) || pose.a_deg > std::max(0.0, high)) {
      refuse(Code::kPoseRange,
             fmt::format("A = {} deg lies beyond its stations, where nothing is known of the "
                         "errors; add stations, or verify within them",
                         plain(pose.a_deg)));
    }
  }
  if (plan.verification.size() >= kHeadPoses) return;
  findings.meaning(Code::kTooFewPoints, where,
                   fmt::format("{} poses do not verify both axes; at least {} are needed",
                               plan.verification.size(), kHeadPoses));
}

void check_five_axis(const FeaturePlan& feature, const std::string& where, Findings& findings) {
  const FiveAxisTask& plan = *feature.five_axis;
  check_balls(plan, where + "/balls", findings);
  if (feature.source) {
    for (const std::string_view key :
         {"/c_stations_deg", "/a_stations_deg", "/verification", "/references"}) {
      if (!findings.is_given(where + std::string(key))) continue;
      findings.meaning(Code::kMeaning, where + std::string(key),
                       "has no effect: the file says where the ball was read; remove it");
    }
    return;
  }
  check_axis_stations(plan.c_stations_deg, "C = A = 0", where + "/c_stations_deg", findings);
  check_axis_stations(plan.a_stations_deg, "C = A = 0", where + "/a_stations_deg", findings);
  check_verification(plan, where + "/verification", findings);
}

}  // namespace

const AnalysisKind& five_axis_kind() {
  static constexpr AnalysisKind kKind = {
      .type = "five_axis",
      .shape = record::Shape::kFiveAxis,
      .forms = kHeadForms,
      .is_simulated = simulates<&SimulationPlan::five_axis>,
      .settings = settings_of_section<&FeaturePlan::five_axis>,
      .files = [](const FeaturePlan& feature) { return source_file(feature, kNestColumns); },
      .check = check_five_axis,
      .simulate = simulate_five_axis};
  return kKind;
}

}  // namespace rondure::plans
