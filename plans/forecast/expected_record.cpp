#include "plans/forecast/expected_record.h"

#include <utility>

#include "plans/analyses/analysis.h"
#include "plans/run/internal/run_head.h"

namespace rondure::plans {
namespace {

record::Touch touch_of(const ForecastTouch& touch, int pose, int repeat) {
  record::Touch out;
  out.pose = pose;
  out.layer = touch.target.layer;
  out.point = touch.target.point;
  out.repeat = repeat;
  out.tip_mm = touch.tip_W_mm;
  out.temperature_degC = out.scale_temperature_degC = 20.0;
  return out;
}

void add_cloud(const ForecastStage& stage, double start_s, record::RunRecord& out) {
  record::PoseVisit pose;
  pose.id = static_cast<int>(out.poses.size());
  pose.feature = stage.feature;
  pose.commanded = pose.reached = stage.pose;
  pose.final_cloud = true;
  pose.time_s = start_s;
  out.poses.push_back(pose);
  for (int repeat = 0; repeat < stage.times; ++repeat) {
    for (const ForecastTouch& measured : stage.measured) {
      record::Touch touch = touch_of(measured, pose.id, repeat);
      touch.id = static_cast<std::int64_t>(out.touches.size());
      touch.time_s = start_s + measured.time_s + repeat * stage.time_s / stage.times;
      out.touches.push_back(touch);
    }
  }
}

}  // namespace

record::RunRecord expected_record(const Plan& plan, const Forecast& forecast) {
  record::RunRecord out = run_head(plan, RunOptions{}, 0);
  double start_s = 0.0;
  for (const ForecastStage& stage : forecast.stages) {
    if (stage.final_cloud) add_cloud(stage, start_s, out);
    start_s += stage.time_s;
  }
  return out;
}

std::uint64_t forecast_seed(const Plan& plan) {
  return plan.simulation ? plan.simulation->seed + 1 : 0;
}

core::Result<record::RunRecord> with_series(record::RunRecord expected, const Plan& plan,
                                            std::uint64_t seed) {
  for (std::size_t i = 0; i < plan.features.size(); ++i) {
    const FeaturePlan& feature = plan.features[i];
    if (analysis_kind(feature.type) == nullptr || measures_by_touch(feature)) continue;
    TRY(auto data, analysis_data(plan, i, seed));
    if (!has_files(feature)) expected.header.seed = seed;
    for (record::Series& series : data.series) expected.series.push_back(std::move(series));
  }
  return expected;
}

}  // namespace rondure::plans
