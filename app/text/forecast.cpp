#include "app/text/forecast.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/numbers.h"
#include "core/units.h"
#include "plans/analyses/features.h"

namespace rondure::app {
namespace {

using nlohmann::ordered_json;
using plans::ForecastStage;

constexpr std::size_t kFewStages = 4;  // identical stages in a row that are listed one by one

std::string feature_of(const plans::Plan& plan, const ForecastStage& stage) {
  if (stage.kind == ForecastStage::Kind::kBase)
    return plan.fixture->datum->on_holes() ? "holes of fixture" : "spheres of fixture";
  return stage.feature < 0 ? plan.probe->qualification.name()
                           : plan.features[static_cast<std::size_t>(stage.feature)].id;
}

const char* name_of(ForecastStage::Kind kind) {
  switch (kind) {
    case ForecastStage::Kind::kQualification:
      return "qualification";
    case ForecastStage::Kind::kBase:
      return "fixture base";
    case ForecastStage::Kind::kRing:
      return "reached pose";
    case ForecastStage::Kind::kLocation:
      return "location";
    case ForecastStage::Kind::kCloud:
      return "cloud";
  }
  return "";
}

/// Rounds, and drops the sign of a zero.
double hundredths(double angle_rad) {
  return std::round(100.0 * angle_rad / core::kDegree) / 100.0 + 0.0;
}

std::string row(const std::string& what, const std::string& feature, const std::string& pose,
                int touches, double path_mm, double time_s) {
  return fmt::format("  {:<16.16} {:<18.18} {:>15} {:>7} {:>9.0f} {:>8}\n", what, feature, pose,
                     touches, path_mm, clock_text(time_s));
}

std::string row_of(const plans::Plan& plan, const ForecastStage& stage) {
  std::string what = name_of(stage.kind);
  if (stage.final_cloud) what = "final cloud";
  if (stage.times > 1) what += fmt::format(" x {}", stage.times);
  const std::string pose = stage.feature < 0 || plans::is_fixed(plan)
                               ? ""
                               : fmt::format("({:.2f}, {:.2f})", hundredths(stage.pose.alpha_rad),
                                             hundredths(stage.pose.beta_rad));
  return row(what, feature_of(plan, stage), pose, stage.times * stage.touches, stage.path_mm,
             stage.time_s);
}

/// Number of identical stages of a grid search from `first` on: its clouds, and the spheres on the
/// ring before each.
std::size_t alike_from(const std::vector<ForecastStage>& stages, std::size_t first) {
  std::size_t end = first;
  const auto searches = [](const ForecastStage& stage) {
    return stage.kind == ForecastStage::Kind::kRing ||
           (stage.kind == ForecastStage::Kind::kCloud && !stage.final_cloud);
  };
  while (end < stages.size() && searches(stages[end]) &&
         stages[end].feature == stages[first].feature) {
    ++end;
  }
  return end - first;
}

std::string rows(const plans::Plan& plan, const std::vector<ForecastStage>& stages) {
  std::string out;
  for (std::size_t i = 0; i < stages.size();) {
    const std::size_t alike = alike_from(stages, i);
    if (alike <= kFewStages) {
      out += row_of(plan, stages[i++]);
      continue;
    }
    ForecastStage sum;
    int clouds = 0;
    for (std::size_t k = 0; k < alike; ++k, ++i) {
      clouds += stages[i].kind == ForecastStage::Kind::kCloud ? 1 : 0;
      sum.touches += stages[i].touches;
      sum.path_mm += stages[i].path_mm;
      sum.time_s += stages[i].time_s;
    }
    out += row(fmt::format("{} clouds", clouds), feature_of(plan, stages[i - 1]),
               fmt::format("{} poses", clouds), sum.touches, sum.path_mm, sum.time_s);
  }
  return out;
}

/// Time and touches of one more pose, for a search that levels the real part.
std::string further_poses(const plans::Plan& plan, const plans::Forecast& forecast) {
  std::string out;
  ForecastStage ring;  // touched in every pose, before the cloud
  for (const ForecastStage& stage : forecast.stages) {
    if (stage.kind == ForecastStage::Kind::kRing) ring = stage;
    if (!stage.final_cloud) continue;
    const plans::FeaturePlan& feature = plan.features[static_cast<std::size_t>(stage.feature)];
    const record::Strategy strategy = feature.pose_search.strategy;
    const bool one_pose = feature.type != record::Shape::kCylinder ||
                          strategy == record::Strategy::kVirtual ||
                          strategy == record::Strategy::kStartPose;
    if (one_pose) continue;
    out += fmt::format("  {}: each further pose {} touches, {:.0f} mm, {}\n", feature.id,
                       stage.touches + ring.touches, stage.path_mm / stage.times + ring.path_mm,
                       clock_text(stage.time_s / stage.times + ring.time_s));
  }
  if (out.empty()) return out;
  return "A part that sits beside its nominal place needs poses more than these:\n" + out;
}

/// What of the tool is kept clear.
std::string tool_line(const plans::Plan& plan) {
  const plans::ProbePlan& probe = *plan.probe;
  if (probe.stylus_length_mm <= 0.0) {
    return fmt::format("Tool: ball {:g} mm; no stylus_length_mm, so only the ball is kept clear\n",
                       probe.tip_diameter_mm);
  }
  return fmt::format("Tool: ball {:g} mm, shaft {:g} x {:g} mm, holder {:g} mm\n",
                     probe.tip_diameter_mm, probe.stylus_diameter_mm, probe.stylus_length_mm,
                     probe.holder_diameter_mm);
}

/// "Clearance: 21340 questions, 18 % answered on meshes", where the plan has bodies.
std::string clearance_line(const plans::Plan& plan, const plans::Questions& questions) {
  if (!plan.fixture || plan.fixture->bodies.empty()) return {};
  const double asked = std::max(1.0, static_cast<double>(questions.asked));
  return fmt::format("Clearance: {} questions, {:.2g} % answered on meshes\n", questions.asked,
                     100.0 * static_cast<double>(questions.on_meshes) / asked);
}

ordered_json stage_json(const plans::Plan& plan, const ForecastStage& stage) {
  ordered_json out = {{"stage", name_of(stage.kind)}, {"feature", feature_of(plan, stage)}};
  if (stage.feature >= 0) {
    out["alpha_deg"] = core::stated_degrees(stage.pose.alpha_rad);
    out["beta_deg"] = core::stated_degrees(stage.pose.beta_rad);
    out["final"] = stage.final_cloud;
  }
  out["times"] = stage.times;
  out["touches"] = stage.times * stage.touches;
  out["path_mm"] = stage.path_mm;
  out["time_s"] = stage.time_s;
  return out;
}

}  // namespace

std::string clock_text(double time_s) {
  const auto s = static_cast<long>(std::lround(time_s));
  if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
  return fmt::format("{}:{:02}", s / 60, s % 60);
}

std::string holder_line(const plans::Plan& plan) {
  if (!plans::is_fixed(plan) || plan.part.held) return {};
  return "Holder: no part.held, so clamps and jaws are not checked; keep the tip clear of them\n";
}

std::string forecast_table(const plans::Plan& plan, const plans::Forecast& forecast) {
  std::string out = fmt::format("{}, revision {}\n", plan.plan.name, plan.plan.revision);
  if (forecast.stages.empty()) return out + "All points come from files: nothing would move.\n";
  out += tool_line(plan) + holder_line(plan);
  out += fmt::format("Speeds: {:g} mm/s between touches, {:g} mm/s in the search\n\n",
                     plan.machine->travel_speed_mm_s, plan.machine->touch_speed_mm_s);
  out += fmt::format("  {:<16} {:<18} {:>15} {:>7} {:>9} {:>8}\n", "stage", "feature",
                     plans::is_fixed(plan) ? "" : "pose deg", "touches", "path mm", "min:s");
  out += rows(plan, forecast.stages);
  out += row("total", "",
             plans::is_fixed(plan) ? std::string() : fmt::format("{} poses", forecast.poses),
             forecast.touches, forecast.path_mm, forecast.time_s);
  const std::string further = further_poses(plan, forecast);
  if (!further.empty()) out += "\n" + further;
  return out + "\n" + clearance_line(plan, forecast.questions) +
         "Every target can be reached where the plan puts the part. Nothing has moved.\n";
}

ordered_json forecast_json(const plans::Plan& plan, const plans::Forecast& forecast) {
  ordered_json out = {{"plan", plan.plan.name},         {"revision", plan.plan.revision},
                      {"touches", forecast.touches},    {"poses", forecast.poses},
                      {"path_mm", forecast.path_mm},    {"time_s", forecast.time_s},
                      {"stages", ordered_json::array()}};
  for (const ForecastStage& stage : forecast.stages) {
    out["stages"].push_back(stage_json(plan, stage));
  }
  out["clearance"] = {{"questions", forecast.questions.asked},
                      {"on_meshes", forecast.questions.on_meshes}};
  return out;
}

std::string problems_json(const std::vector<core::Error>& problems) {
  ordered_json list = ordered_json::array();
  for (const core::Error& p : problems) {
    list.push_back({{"code", core::code_name(p.code)}, {"where", p.where}, {"what", p.what}});
  }
  return ordered_json{{"problems", list}}.dump(2, ' ', false,
                                               nlohmann::json::error_handler_t::replace) +
         "\n";
}

}  // namespace rondure::app
