#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "fit/rotary/ball_setup.h"
#include "plans/analyses/internal/kinds.h"
#include "plans/analyses/internal/series_file.h"
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
constexpr std::array<std::string_view, 3> kPoseSteps = {"C", "A", "verification"};
constexpr std::array<record::WantedColumn, 3> kPoseColumns = {
    {{"step", true, kPoseSteps}, {"c_deg"}, {"a_deg"}}};
constexpr std::array<std::string_view, 3> kPoseKeys = {"/c_stations_deg", "/a_stations_deg",
                                                       "/verification"};
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

/// Why a row of a file of poses does not fit: its column, and what is wrong. The rows before it are
/// in `task`.
std::optional<std::string> fault_of_pose(const record::Series& file, std::size_t row,
                                         const FiveAxisTask& task) {
  const double* const value = &file.values[row * kPoseColumns.size()];
  for (const auto& [column, limit_deg] :
       {std::pair(std::size_t{1}, 360.0), std::pair(std::size_t{2}, 180.0)}) {
    if (std::abs(value[column]) <= limit_deg) continue;
    return fmt::format("{}: {} deg is outside +-{:g} deg", kPoseColumns[column].name,
                       plain(value[column]), limit_deg);
  }
  const auto step = static_cast<std::size_t>(value[0]);
  if (step == 2) return std::nullopt;
  const std::size_t own = step + 1;
  const std::size_t other = 2 - step;
  if (value[other] != 0.0) {
    return fmt::format("{}: {} deg at a station of {}, where the other axis stands at 0",
                       kPoseColumns[other].name, plain(value[other]), kPoseSteps[step]);
  }
  if (is_on(step == 0 ? task.c_stations_deg : task.a_stations_deg, value[own])) {
    return fmt::format("{}: the station {} deg of {} stands in an earlier row; remove one",
                       kPoseColumns[own].name, plain(value[own]), kPoseSteps[step]);
  }
  return std::nullopt;
}

void read_poses_of(const Plan& plan, FiveAxisTask& task, const std::string& where,
                   Findings& findings) {
  const std::string place = where + "/poses";
  for (const std::string_view key : kPoseKeys) {
    if (!findings.is_given(where + std::string(key))) continue;
    findings.meaning(Code::kMeaning, where + std::string(key),
                     "has no effect: the file \"poses\" says where the ball is read; remove one");
  }
  const auto file = [&]() -> core::Result<record::Series> {
    TRY(const auto bytes, read_data_file(plan.folder / task.poses, task.poses));
    return record::parse_series_csv(bytes, task.poses, kPoseColumns);
  }();
  if (!file) {
    const core::Error& error = file.error();
    findings.meaning(error.code, place,
                     error.where.empty() ? error.what : error.where + ": " + error.what);
    return;
  }
  for (std::size_t row = 0; row < file->rows(); ++row) {
    if (const auto fault = fault_of_pose(*file, row, task)) {
      findings.meaning(Code::kMeaning, place,
                       fmt::format("{}, row {}, {}", task.poses, row + 1, *fault));
      continue;
    }
    const double* const value = &file->values[row * kPoseColumns.size()];
    if (value[0] == 0.0) task.c_stations_deg.push_back(value[1]);
    if (value[0] == 1.0) task.a_stations_deg.push_back(value[2]);
    if (value[0] != 2.0) continue;
    task.verification.push_back({value[1], value[2]});
    task.verification_rows.push_back(row + 1);
  }
}

void check_verification(const FiveAxisTask& plan, const std::string& where, Findings& findings) {
  if (!findings.sound(where)) return;
  const auto [low, high] = plan.a_stations_deg.empty()
                               ? std::ranges::min_max_result<double>{0.0, 0.0}
                               : std::ranges::minmax(plan.a_stations_deg);
  for (std::size_t i = 0; i < plan.verification.size(); ++i) {
    const record::HeadPoseTask& pose = plan.verification[i];
    const auto refuse = [&](Code code, std::string why) {
      if (plan.poses.empty()) {
        findings.meaning(code, item_pointer(where, i), std::move(why));
      } else {
        findings.meaning(code, where,
                         fmt::format("{}, row {}, c_deg, a_deg: {}", plan.poses,
                                     plan.verification_rows[i], why));
      }
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
         {"/c_stations_deg", "/a_stations_deg", "/verification", "/references", "/poses"}) {
      if (!findings.is_given(where + std::string(key))) continue;
      findings.meaning(Code::kMeaning, where + std::string(key),
                       "has no effect: the file says where the ball was read; remove it");
    }
    return;
  }
  // What a file says is wrong in the file.
  const auto place = [&](std::string_view key) {
    return where + std::string(plan.poses.empty() ? key : "/poses");
  };
  check_axis_stations(plan.c_stations_deg, "C = A = 0", place(kPoseKeys[0]), findings);
  check_axis_stations(plan.a_stations_deg, "C = A = 0", place(kPoseKeys[1]), findings);
  check_verification(plan, place(kPoseKeys[2]), findings);
}

}  // namespace

void read_head_poses(Plan& plan, Findings& findings) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const std::string where = feature_pointer(i) + "/five_axis";
    auto& task = plan.features[i].five_axis;
    if (!task || task->poses.empty() || plan.features[i].source || !findings.sound(where)) continue;
    read_poses_of(plan, *task, where, findings);
  }
}

core::Result<void> check_same_poses(const FeaturePlan& feature,
                                    const std::vector<record::Setting>& recorded) {
  if (!feature.five_axis || feature.five_axis->poses.empty()) return {};
  const FiveAxisTask& now = *feature.five_axis;
  const auto before = record::task_of<FiveAxisTask>(recorded);
  const auto alike = [](const record::HeadPoseTask& a, const record::HeadPoseTask& b) {
    return a.c_deg == b.c_deg && a.a_deg == b.a_deg;
  };
  if (before && before->c_stations_deg == now.c_stations_deg &&
      before->a_stations_deg == now.a_stations_deg &&
      std::ranges::equal(before->verification, now.verification, alike)) {
    return {};
  }
  return core::fail_with(Code::kMeaning,
                         "{} does not hold the poses that the run began with; put that file back, "
                         "or start a new run",
                         now.poses);
}

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
