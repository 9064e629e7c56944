// Data of a file that no longer stand for the part: specification, section 7, gate "age".
#include "evaluation/results/gates.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "record/tasks/settings.h"
#include "record/tasks/wheel.h"

namespace rondure::evaluation {
namespace {

using record::RunRecord;
using ::testing::HasSubstr;

/// A wheel of 16 points of a file that was measured some time before the run.
RunRecord wheel_of(const std::string& measured_utc, double valid_for_days) {
  RunRecord run;
  run.ending = "finished";
  run.header.decision_rule = "simple-acceptance";
  run.header.started_utc = "2026-11-23T12:00:00Z";
  record::Feature wheel;
  wheel.id = "wheel";
  wheel.shape = record::Shape::kWheel;
  wheel.strategy = record::Strategy::kSeries;
  wheel.settings = {{"mode", std::nullopt, "indexed"},
                    {"nominal_radius_mm", 50.0, ""},
                    {"source/measured_utc", std::nullopt, measured_utc},
                    {"source/valid_for_days", valid_for_days, ""}};
  wheel.characteristics = {
      {"R", record::Form::kRadius, record::Reference::kLeastSquares, 0.05, ""}};
  run.features = {wheel};
  record::Series data;
  data.columns = {{"x", "mm"}, {"z", "mm"}};
  for (int i = 0; i < 16; ++i) {
    const double t = 2.0 * std::numbers::pi * i / 16.0;
    const double r = 50.0 + 1e-3 * std::cos(2.0 * t) + 4e-4 * std::cos(5.0 * t + 1.0);
    data.values.insert(data.values.end(), {r * std::cos(t), r * std::sin(t)});
  }
  run.series = {data};
  return run;
}

FeatureResult evaluated_wheel_of(const RunRecord& run) {
  auto evaluation = evaluate(run);
  EXPECT_TRUE(evaluation) << (evaluation ? "" : evaluation.error().what);
  return evaluation ? evaluation->features.at(0) : FeatureResult();
}

const Gate* age_in(const FeatureResult& feature) {
  for (const Gate& gate : feature.gates) {
    if (gate.code == "stale-input") return &gate;
  }
  return nullptr;
}

TEST(AgeGate, PassesDataThatStillStand) {
  const FeatureResult wheel = evaluated_wheel_of(wheel_of("2026-11-21T00:00:00Z", 3.0));
  const Gate* const age = age_in(wheel);
  ASSERT_NE(age, nullptr) << "gates are listed, passed or not";
  EXPECT_EQ(age->outcome, Gate::Outcome::kPassed);
  EXPECT_DOUBLE_EQ(*age->found, 2.5);
  EXPECT_EQ(age->limit, 3.0);
  EXPECT_EQ(wheel.characteristics.at(0).verdict, Verdict::kConforms)
      << wheel.characteristics.at(0).reason;
}

TEST(AgeGate, VoidsOldData) {
  const FeatureResult wheel = evaluated_wheel_of(wheel_of("2026-11-13T12:00:00Z", 3.0));
  ASSERT_NE(age_in(wheel), nullptr);
  EXPECT_EQ(age_in(wheel)->outcome, Gate::Outcome::kVoids);
  EXPECT_EQ(wheel.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(wheel.characteristics.at(0).reason.english(),
              HasSubstr("are 10 days old, they stand for 3 days"));
}

TEST(AgeGate, VoidsDataOfTheFutureAndOfNoTime) {
  const FeatureResult future = evaluated_wheel_of(wheel_of("2026-11-23T12:00:01Z", 3.0));
  EXPECT_EQ(future.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(future.characteristics.at(0).reason.english(), HasSubstr("after the start"));
  RunRecord timeless = wheel_of("2026-11-21T00:00:00Z", 3.0);
  timeless.header.started_utc.clear();
  const FeatureResult unknown = evaluated_wheel_of(timeless);
  EXPECT_EQ(unknown.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(unknown.characteristics.at(0).reason.english(), HasSubstr("is not known"));
}

// "Path: R_used ... older than one dressing: no G-code" (section 5.3).
TEST(AgeGate, LeavesNoPathOfAnOldWheel) {
  record::WheelTask task;
  task.nominal_radius_mm = 50.0;
  task.surface.emplace();
  task.surface->coefficients = {0.0, 0.0, 0.5 / 80.0};
  task.surface->from_mm = -20.0;
  task.surface->to_mm = 20.0;
  task.surface->step_mm = 1.0;
  const auto has_path = [&](const std::string& measured_utc) {
    RunRecord run = wheel_of(measured_utc, 3.0);
    std::vector<record::Setting> settings = record::settings_of_task(task);
    settings.insert(settings.end(), run.features[0].settings.begin() + 2,
                    run.features[0].settings.end());
    run.features[0].settings = settings;
    const FeatureResult wheel = evaluated_wheel_of(run);
    EXPECT_TRUE(wheel.analysis);
    if (!wheel.analysis) return false;
    const auto& found = std::get<WheelResult>(wheel.analysis->found).evaluation;
    EXPECT_NE(found.path.has_value(), found.refused.has_value());
    if (found.refused) {
      EXPECT_THAT(found.refused->what, HasSubstr("out of date"));
    }
    return found.path.has_value();
  };
  EXPECT_TRUE(has_path("2026-11-21T00:00:00Z"));
  EXPECT_FALSE(has_path("2026-11-13T12:00:00Z"));
}

TEST(AgeGate, IsNoneWhereThePlanSaysNothing) {
  RunRecord run = wheel_of("2026-11-13T12:00:00Z", 3.0);
  run.features[0].settings.resize(2);
  EXPECT_FALSE(age_gate(run, run.features[0]));
  EXPECT_EQ(evaluated_wheel_of(run).characteristics.at(0).verdict, Verdict::kConforms);
}

}  // namespace
}  // namespace rondure::evaluation
