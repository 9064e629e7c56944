// The radius of an earlier wheel as wheel radius of a swing arm and of ground pins, with its
// uncertainty. Wheels, pins and readings are simulated by other code (simulated_analyses.h); what
// a wrong arm does is printed in the method specification, analyses_uncertainty 2.2.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/analysis.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "record/tasks/settings.h"
#include "record/tasks/wheel.h"
#include "tests/evaluation/simulated_analyses.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::kMicrometre;
using core::kTwoPi;
using record::Form;
using record::WheelTask;
using ::testing::HasSubstr;

constexpr const char* kWheelFeature = "ground with";

/// A wheel at speed, 16 exact points of the circle that it sweeps.
struct SweptWheel {
  double nominal_mm = 299.88;
  double radius_mm = 299.88;
  int points = 16;
  std::optional<double> point_um = 0.0;  ///< As declared.
  double threshold_um = 0.0;             ///< u(R), as nothing else is declared.
};

/// The run of a feature that takes its radius, with that wheel before it.
record::RunRecord after_wheel(const SweptWheel& wheel, record::RunRecord run) {
  WheelTask task;
  task.mode = WheelTask::Mode::kEnvelope;
  task.nominal_radius_mm = wheel.nominal_mm;
  auto& influences = task.uncertainty.emplace();
  if (wheel.point_um) influences.point_um = declared(*wheel.point_um);
  influences.threshold_um = declared(wheel.threshold_um);
  record::Feature first = run.features.front();
  first.id = kWheelFeature;
  first.shape = record::Shape::kWheel;
  first.settings = record::settings_of_task(task);
  first.characteristics = {asked(Form::kRadius, 20'000.0)};
  run.features.insert(run.features.begin(), first);
  for (record::Series& one : run.series) one.feature = 1;
  record::Series points;
  points.name = "data";
  points.feature = 0;
  points.columns = {{"x", "mm"}, {"z", "mm"}};
  for (int i = 0; i < wheel.points; ++i) {
    const double angle = kTwoPi * i / 16.0;
    points.values.push_back(3.0 + wheel.radius_mm * std::cos(angle));
    points.values.push_back(-7.0 + wheel.radius_mm * std::sin(angle));
  }
  run.series.insert(run.series.begin(), std::move(points));
  run.header.decision_rule = "simple-acceptance";
  return run;
}

/// Layout A on a wheel that is 0.1 mm smaller than when its head was set: as printed, the probes
/// are turned by +0.2333 and -0.2332 deg.
struct WornArm {
  SimulatedSpindle world = worked_spindle(record::SpindleTask::Layout::kPublishedA);
  record::SpindleTask task;

  WornArm() {
    world.places_rad[1] += 0.2333 * core::kDegree;
    world.places_rad[2] -= 0.2332 * core::kDegree;
    world.wheel_mm -= 0.1;
    task = spindle_task(record::SpindleTask::Layout::kPublishedA, world);
    task.probe_noise_um = 0.001;
  }

  [[nodiscard]] record::RunRecord record() const {
    Normals draws(3);
    record::RunRecord out = spindle_run(world, task, draws);
    out.features.front().characteristics = {asked(Form::kRoundness, 100.0),
                                            asked(Form::kMotionSynchronous, 100.0)};
    return out;
  }
  void take_radius() {
    task.wheel_radius_mm = record::SpindleTask().wheel_radius_mm;
    task.wheel_radius_from.emplace().feature = kWheelFeature;
  }
};

const Gate* chain_gate_of(const FeatureResult& result) {
  const auto found = std::ranges::find(result.gates, "chain-void", &Gate::code);
  return found == result.gates.end() ? nullptr : &*found;
}

/// The second feature, evaluated and judged.
FeatureResult second_of(const record::RunRecord& run) {
  const auto evaluation = evaluate(run);
  EXPECT_TRUE(evaluation);
  return evaluation ? evaluation->features.at(1) : FeatureResult();
}

double read_um(const FeatureResult& result, std::size_t characteristic) {
  const auto& judged = result.characteristics.at(characteristic);
  EXPECT_TRUE(judged.value) << judged.reason.english();
  return judged.value ? *judged.value_mm() / kMicrometre : std::nan("");
}

TEST(WheelRadiusFlow, AWornWheelNoLongerTurnsTheProbes) {
  SweptWheel wheel;
  wheel.radius_mm = 299.78;
  WornArm arm;
  arm.task.wheel_radius_mm = 299.88;
  const FeatureResult by_number = second_of(after_wheel(wheel, arm.record()));
  // The readings here are of first order, those behind these two figures are exact. 4.300 is
  // printed for the motion with its one cycle a turn of X and Y; without, a separation written
  // apart from this program finds 4.276.
  EXPECT_NEAR(read_um(by_number, 0), 10.517, 0.01);
  EXPECT_NEAR(read_um(by_number, 1), 4.276, 0.01);
  EXPECT_EQ(chain_gate_of(by_number), nullptr);
  arm.take_radius();
  const FeatureResult measured = second_of(after_wheel(wheel, arm.record()));
  EXPECT_NEAR(read_um(measured, 0), 12.314, 0.005);
  EXPECT_NEAR(read_um(measured, 1), 2.949, 0.005);
  ASSERT_NE(chain_gate_of(measured), nullptr);
  EXPECT_EQ(chain_gate_of(measured)->outcome, Gate::Outcome::kPassed);
  for (const CharacteristicResult& judged : measured.characteristics) {
    EXPECT_EQ(judged.verdict, Verdict::kConforms) << judged.reason.english();
  }
}

TEST(WheelRadiusFlow, AnArmOfTheNominalWheelChangesNothing) {
  WornArm arm;
  arm.world = worked_spindle(record::SpindleTask::Layout::kPublishedA);
  arm.take_radius();
  const FeatureResult measured = second_of(after_wheel({}, arm.record()));
  EXPECT_NEAR(read_um(measured, 0), true_roundness_um(arm.world), 0.005);
}

/// Statement of RONt of an arm whose eccentricity is 0 and whose noise hides what the motion shows
/// of turned probes: only declarations say how far they are, by the wheel or by the arm.
std::optional<UncertaintyStatement> roundness_of(double threshold_um, std::optional<double> arm_mm,
                                                 std::vector<BudgetLine>* budget = nullptr) {
  SweptWheel wheel;
  wheel.threshold_um = threshold_um;
  WornArm arm;
  arm.world = worked_spindle(record::SpindleTask::Layout::kPublishedA);
  arm.world.eccentricity_um = 0.0;
  arm.world.noise_um = 0.05;
  auto& influences = arm.task.uncertainty.emplace();
  influences.noise_um = declared(0.05);
  influences.gain_1 = declared(1e-5);
  influences.angle_deg = declared(1e-4);
  if (arm_mm) influences.arm_mm = declared(*arm_mm);
  arm.take_radius();
  const FeatureResult result = second_of(after_wheel(wheel, arm.record()));
  const auto& judged = result.characteristics.at(0);
  EXPECT_TRUE(judged.value && judged.value->statement() != nullptr) << judged.reason.english();
  if (!judged.value || judged.value->statement() == nullptr) return std::nullopt;
  if (budget != nullptr) *budget = judged.value->uncertainty().result()->budget;
  return *judged.value->statement();
}

/// RONt of an arm of the stated length on a wheel so much smaller.
double roundness_at_wear_um(double wear_mm) {
  WornArm arm;
  arm.world = worked_spindle(record::SpindleTask::Layout::kPublishedA);
  arm.world.eccentricity_um = 0.0;
  for (double& place : arm.world.places_rad) {
    place += wear_mm * std::sin(place) / arm.world.pin_mm;
  }
  arm.task.wheel_radius_mm = arm.world.wheel_mm;
  return read_um(second_of(after_wheel({}, arm.record())), 0);
}

TEST(WheelRadiusFlow, TheUncertaintyOfTheRadiusEntersRoundness) {
  // Probes that are turned in the readings, by a length that the plan states without error.
  const double expected_um =
      0.5 * std::abs(roundness_at_wear_um(0.02) - roundness_at_wear_um(-0.02));
  ASSERT_GT(expected_um, 0.1);
  std::vector<BudgetLine> budget;
  const auto exact = roundness_of(0.0, std::nullopt);
  const auto measured = roundness_of(20.0, std::nullopt, &budget);
  const auto by_arm = roundness_of(0.0, 0.020);
  ASSERT_TRUE(exact && measured && by_arm);
  const double noise_um = exact->standard_uncertainty_mm / kMicrometre;
  EXPECT_LT(noise_um, 0.25 * expected_um);
  EXPECT_NEAR(measured->standard_uncertainty_mm / kMicrometre, std::hypot(noise_um, expected_um),
              0.1 * expected_um);
  EXPECT_NEAR(measured->standard_uncertainty_mm, by_arm->standard_uncertainty_mm,
              0.05 * by_arm->standard_uncertainty_mm);
  const auto line = std::ranges::find(budget, "wheel-radius", &BudgetLine::name);
  ASSERT_NE(line, budget.end());
  EXPECT_NEAR(line->standard_uncertainty_mm / kMicrometre, expected_um, 0.05 * expected_um);
}

TEST(WheelRadiusFlow, ARadiusWithoutNoiseOfItsPointsLeavesNoInterval) {
  SweptWheel wheel;
  wheel.point_um.reset();
  WornArm arm;
  auto& influences = arm.task.uncertainty.emplace();
  influences.gain_1 = declared(0.002);
  influences.angle_deg = declared(0.3);
  arm.take_radius();
  const FeatureResult result = second_of(after_wheel(wheel, arm.record()));
  const auto& judged = result.characteristics.at(0);
  ASSERT_TRUE(judged.value);
  EXPECT_EQ(judged.value->statement(), nullptr);
  EXPECT_THAT(judged.value->uncertainty().why().english(), HasSubstr("declares no point_um"));
}

/// Two pins ground by a small wheel, whose radius moves f by more than that of a usual one. The
/// errors are small: what they do in second order is not in the formula.
struct GroundPins {
  SimulatedContour world;
  record::ContourTask task;

  explicit GroundPins(double wheel_mm) {
    world.wheel_mm = wheel_mm;
    world.x_error = {{6, 1.0, 2.0944}, {7, 0.8, 0.0}};
    world.c_error = {{5, 6.0, 1.0}};
    world.c_scale = {1.0, 1.0};
    world.own = {{}, {}};
    world.gauge_um = 0.0;
    world.c_trace_mdeg = 0.0;
    world.x_trace_um = 0.0;
    task.wheel_radius_from.emplace().feature = kWheelFeature;
    auto& influences = task.uncertainty.emplace();
    influences.gauge_um = declared(0.0);
    influences.x_trace_um = declared(1e-4);
    influences.skew_ms = declared(0.0);
  }
  [[nodiscard]] record::RunRecord record() const {
    Normals draws(5);
    record::RunRecord out = contour_run(world, task, draws);
    out.features.front().characteristics = {asked(Form::kContourDeviation, 100.0)};
    return out;
  }
  /// Peak to valley of f by the first-order formula of the specification: nothing else is ground.
  [[nodiscard]] double following_um() const { return true_contour(world).deviation_um; }
};

const ContourNumber* number_of(const FeatureResult& result, const std::string& name) {
  EXPECT_TRUE(result.analysis) << (result.failure ? result.failure->what : "");
  if (!result.analysis) return nullptr;
  const auto& numbers = std::get<ContourResult>(result.analysis->found).numbers;
  const auto found = std::ranges::find_if(
      numbers, [&](const ContourNumber& one) { return one.name() == name && one.part == 0U; });
  return found == numbers.end() ? nullptr : &*found;
}

TEST(WheelRadiusFlow, WhatFollowsTheAxesIsThatOfTheMeasuredWheel) {
  SweptWheel wheel;
  wheel.nominal_mm = 100.0;
  wheel.radius_mm = 96.0;
  const FeatureResult result = second_of(after_wheel(wheel, GroundPins(96.0).record()));
  const auto* const following = number_of(result, "following-pv");
  ASSERT_NE(following, nullptr);
  const double expected_um = GroundPins(96.0).following_um();
  ASSERT_GT(GroundPins(100.0).following_um() - expected_um, 0.015);
  EXPECT_NEAR(following->as_measured / kMicrometre, expected_um, 0.003);
  const auto* const rest = number_of(result, "rest-pv");
  ASSERT_NE(rest, nullptr);
  EXPECT_LT(rest->as_measured / kMicrometre, 0.01);  // nothing but f was ground
}

TEST(WheelRadiusFlow, TheUncertaintyOfTheRadiusEntersWhatFollows) {
  SweptWheel wheel;
  wheel.nominal_mm = wheel.radius_mm = 96.0;
  const auto stated = [&](double threshold_um) {
    wheel.threshold_um = threshold_um;
    const FeatureResult result = second_of(after_wheel(wheel, GroundPins(96.0).record()));
    const auto* const following = number_of(result, "following-pv");
    const bool known = following != nullptr && following->uncertainty.result();
    EXPECT_TRUE(known);
    return known ? following->uncertainty.result() : std::nullopt;
  };
  const auto exact = stated(0.0);
  const auto measured = stated(100.0);
  ASSERT_TRUE(exact && measured);
  // By the formula, 0.1 mm to either side.
  const double per_u_um = 0.5 * (GroundPins(96.1).following_um() - GroundPins(95.9).following_um());
  ASSERT_GT(per_u_um, 0.0004);
  const auto line = std::ranges::find(measured->budget, "wheel-radius", &BudgetLine::name);
  ASSERT_NE(line, measured->budget.end());
  EXPECT_NEAR(line->standard_uncertainty_mm / kMicrometre, per_u_um, 0.05 * per_u_um);
  EXPECT_NEAR(std::sqrt(std::pow(measured->sampled.standard_uncertainty_mm, 2) -
                        std::pow(exact->sampled.standard_uncertainty_mm, 2)) /
                  kMicrometre,
              per_u_um, 0.1 * per_u_um);
}

TEST(WheelRadiusFlow, AVoidWheelVoidsArmAndPins) {
  SweptWheel failed;
  failed.points = 5;
  WornArm arm;
  arm.take_radius();
  for (const record::RunRecord& run :
       {after_wheel(failed, arm.record()), after_wheel(failed, GroundPins(299.88).record())}) {
    const FeatureResult result = second_of(run);
    ASSERT_NE(chain_gate_of(result), nullptr);
    EXPECT_EQ(chain_gate_of(result)->outcome, Gate::Outcome::kVoids);
    ASSERT_FALSE(result.characteristics.empty());
    for (const CharacteristicResult& judged : result.characteristics) {
      EXPECT_EQ(judged.verdict, Verdict::kVoid);
      EXPECT_THAT(judged.reason.english(), HasSubstr("ground with, which is void: there are 5"));
    }
  }
}

}  // namespace
}  // namespace rondure::reports
