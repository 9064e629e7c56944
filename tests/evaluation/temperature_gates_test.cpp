// Limits and drift of the temperature, of series and of touches.
#include "evaluation/results/gates.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/evaluate.h"
#include "evaluation/results/thermal.h"

namespace rondure::evaluation {
namespace {

using record::RunRecord;
using ::testing::HasSubstr;

using Column = std::optional<std::vector<double>>;

/// Sixteen temperatures around 20 degC that rise by a range.
std::vector<double> rising(double from_degC, double by_K) {
  std::vector<double> out;
  for (int i = 0; i < 16; ++i) out.push_back(from_degC + by_K * i / 15.0);
  return out;
}

/// A wheel of 16 points with its temperatures, under limits of 18 to 22 degC.
RunRecord wheel_at(const Column& degC) {
  RunRecord run;
  run.ending = "finished";
  run.header.decision_rule = "simple-acceptance";
  run.header.temperature_min_degC = 18.0;
  run.header.temperature_max_degC = 22.0;
  run.settings = {{"environment/declared", std::nullopt, "limits"}};
  record::Feature wheel;
  wheel.id = "wheel";
  wheel.shape = record::Shape::kWheel;
  wheel.strategy = record::Strategy::kSeries;
  wheel.settings = {{"mode", std::nullopt, "indexed"}, {"nominal_radius_mm", 50.0, ""}};
  wheel.characteristics = {
      {"R", record::Form::kRadius, record::Reference::kLeastSquares, 0.05, ""}};
  run.features = {wheel};
  record::Series data;
  data.columns = {{"x", "mm"}, {"z", "mm"}};
  if (degC) data.columns.push_back({"temperature_degC", "degC"});
  for (std::size_t i = 0; i < 16; ++i) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(i) / 16.0;
    const double r = 50.0 + 1e-3 * std::cos(2.0 * t) + 4e-4 * std::cos(5.0 * t + 1.0);
    data.values.insert(data.values.end(), {r * std::cos(t), r * std::sin(t)});
    if (degC) data.values.push_back(degC->at(i));
  }
  run.series = {data};
  return run;
}

FeatureResult only_feature(const RunRecord& run) {
  auto evaluation = evaluate(run);
  EXPECT_TRUE(evaluation) << evaluation.error().what;
  return evaluation ? evaluation->features.at(0) : FeatureResult();
}

/// The gate of a code; a test fails without it.
Gate gate_named(const FeatureResult& feature, const std::string& code) {
  for (const Gate& gate : feature.gates) {
    if (gate.code == code) return gate;
  }
  ADD_FAILURE() << "no gate " << code;
  return {};
}

TEST(TemperatureGates, OfASeriesPassWithValueAndLimit) {
  const FeatureResult wheel = only_feature(wheel_at(rising(20.2, 0.4)));
  const Gate limits = gate_named(wheel, "temperature");
  EXPECT_EQ(limits.outcome, Gate::Outcome::kPassed);
  EXPECT_NEAR(*limits.found, 20.4, 1e-9) << "the mean";
  EXPECT_EQ(limits.limit, 22.0) << "the nearer one";
  EXPECT_EQ(limits.unit, "degC");
  const Gate drift = gate_named(wheel, "temperature-drift");
  EXPECT_EQ(drift.outcome, Gate::Outcome::kPassed);
  EXPECT_NEAR(*drift.found, 0.4, 1e-9);
  EXPECT_EQ(drift.limit, 0.5);
  const CharacteristicResult& radius = wheel.characteristics.at(0);
  EXPECT_EQ(radius.verdict, Verdict::kConforms) << radius.reason;
  EXPECT_THAT(radius.value->sentence(), HasSubstr("20.4 degC"));
}

TEST(TemperatureGates, VoidASeriesOutsideTheLimitsOrWithTooMuchDrift) {
  const CharacteristicResult warm = only_feature(wheel_at(rising(34.9, 0.2))).characteristics.at(0);
  EXPECT_EQ(warm.verdict, Verdict::kVoid);
  EXPECT_THAT(warm.reason, HasSubstr("temperature 35.00 degC is outside 18..22 degC"));
  // A single warm reading is drift; the mean is inside.
  RunRecord run = wheel_at(rising(20.0, 0.8));
  const FeatureResult drifting = only_feature(run);
  EXPECT_EQ(gate_named(drifting, "temperature").outcome, Gate::Outcome::kPassed);
  EXPECT_EQ(gate_named(drifting, "temperature-drift").outcome, Gate::Outcome::kVoids);
  EXPECT_EQ(drifting.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(drifting.characteristics.at(0).reason,
              HasSubstr("the temperature changed by 0.80 K at one place while it was measured, the "
                        "limit is 0.5 K"));
  run.settings.push_back({"environment/max_drift_K", 1.0, ""});
  EXPECT_EQ(only_feature(run).characteristics.at(0).verdict, Verdict::kConforms);
}

TEST(TemperatureGates, VoidASeriesWithoutATemperatureUnlessOneIsDeclared) {
  RunRecord run = wheel_at({});
  const FeatureResult bare = only_feature(run);
  EXPECT_FALSE(gate_named(bare, "temperature").found);
  EXPECT_EQ(bare.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(bare.characteristics.at(0).reason,
              HasSubstr("the temperature was not recorded, the limits are 18..22 degC"));
  run.settings.push_back({"environment/assumed_degC", 20.5, ""});
  const CharacteristicResult declared = only_feature(run).characteristics.at(0);
  EXPECT_EQ(declared.verdict, Verdict::kConforms) << declared.reason;
  EXPECT_THAT(declared.value->sentence(), HasSubstr("20.5 degC declared, not measured"));
}

TEST(TemperatureGates, AreNoneWhereThePlanStatesNoLimits) {
  RunRecord run = wheel_at(rising(35.0, 2.0));
  run.settings.clear();
  const FeatureResult wheel = only_feature(run);
  for (const Gate& gate : wheel.gates) {
    EXPECT_FALSE(gate.code.starts_with("temperature")) << gate.code;
  }
  EXPECT_EQ(wheel.characteristics.at(0).verdict, Verdict::kConforms);
}

/// A calibration of two balls, each touched at two stations, at these temperatures.
FeatureResult calibration_at(const std::vector<double>& first_degC,
                             const std::vector<double>& second_degC, RunRecord& run) {
  run.header.temperature_min_degC = 18.0;
  run.header.temperature_max_degC = 22.0;
  run.touches.clear();
  for (std::size_t station = 0; station < first_degC.size(); ++station) {
    for (int ball = 0; ball < 2; ++ball) {
      record::Touch touch;
      touch.pose = static_cast<int>(station);
      touch.layer = ball;
      touch.temperature_degC = ball == 0 ? first_degC[station] : second_degC[station];
      run.touches.push_back(touch);
    }
  }
  FeatureResult out;
  out.feature.shape = record::Shape::kRotaryAxes;
  out.feature.strategy = record::Strategy::kStations;
  std::vector<const record::Touch*> touches;
  for (const record::Touch& touch : run.touches) touches.push_back(&touch);
  out.temperatures = temperatures_of(run, touches);
  return out;
}

TEST(TemperatureGates, OfACalibrationCompareEachPlaceWithItself) {
  RunRecord run;
  // The upper ball is warmer, and both are steady.
  FeatureResult steady = calibration_at({19.9, 20.0}, {20.8, 20.9}, run);
  std::vector<Gate> gates = temperature_gates(run, steady);
  ASSERT_EQ(gates.size(), 2U);
  EXPECT_EQ(gates[0].outcome, Gate::Outcome::kPassed);
  EXPECT_EQ(gates[1].outcome, Gate::Outcome::kPassed);
  EXPECT_NEAR(*gates[1].found, 0.1, 1e-9);
  const FeatureResult warming = calibration_at({19.9, 20.5}, {20.8, 20.9}, run);
  gates = temperature_gates(run, warming);
  EXPECT_EQ(gates[0].outcome, Gate::Outcome::kPassed);
  EXPECT_EQ(gates[1].outcome, Gate::Outcome::kVoids);
  EXPECT_NEAR(*gates[1].found, 0.6, 1e-9);
  // One warm touch is outside, whatever the mean.
  const FeatureResult warm = calibration_at({20.0, 20.0}, {20.0, 35.0}, run);
  gates = temperature_gates(run, warm);
  EXPECT_EQ(gates[0].outcome, Gate::Outcome::kVoids);
  EXPECT_THAT(gates[0].reason, HasSubstr("temperature 35.00 degC is outside 18..22 degC"));
}

TEST(TemperatureGates, OfASurfaceHaveNoDrift) {
  RunRecord run;
  FeatureResult shaft = calibration_at({19.0, 21.0}, {19.0, 21.0}, run);
  shaft.feature.shape = record::Shape::kCylinder;
  shaft.feature.strategy = record::Strategy::kGuided;
  const std::vector<Gate> gates = temperature_gates(run, shaft);
  ASSERT_EQ(gates.size(), 1U);
  EXPECT_EQ(gates[0].code, "temperature");
  EXPECT_EQ(gates[0].outcome, Gate::Outcome::kPassed);
}

// The scales of the machine touched no points of the file.
TEST(Compensated, APointsFileBesideATouchedSurfaceFollowsThePartAlone) {
  RunRecord run;
  run.settings = {{"environment/declared", std::nullopt, "limits"},
                  {"environment/assumed_degC", 22.0, ""}};
  record::Feature touched;
  touched.strategy = record::Strategy::kGuided;
  touched.settings = {{"part_expansion_per_K", 23e-6, ""}, {"scale_expansion_per_K", 8e-6, ""}};
  record::Feature of_file;
  of_file.strategy = record::Strategy::kPointsFile;
  of_file.settings = {{"part_expansion_per_K", 23e-6, ""}};
  run.features = {touched, of_file};
  run.poses = {{1, 0, {}, {}, false, 0.0}, {2, 1, {}, {}, false, 0.0}};
  record::Touch touch;
  touch.tip_mm = {100.0, 0.0, 0.0};
  touch.purpose = record::Touch::Purpose::kQualification;
  touch.pose = -1;
  run.touches.push_back(touch);
  touch.purpose = record::Touch::Purpose::kMeasure;
  for (const int pose : {1, 2}) {
    touch.pose = pose;
    run.touches.push_back(touch);
  }
  const auto at_20 = compensated(run);
  ASSERT_TRUE(at_20);
  const double scales = 1.0 + 2.0 * 8e-6;
  const double part = 1.0 + 2.0 * 23e-6;
  EXPECT_NEAR(at_20->touches[0].tip_mm.x(), 100.0 * scales, 1e-12);
  EXPECT_NEAR(at_20->touches[1].tip_mm.x(), 100.0 * scales / part, 1e-12);
  EXPECT_NEAR(at_20->touches[2].tip_mm.x(), 100.0 / part, 1e-12);
}

}  // namespace
}  // namespace rondure::evaluation
