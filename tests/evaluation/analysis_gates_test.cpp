// False acceptances that must not come back: measurements whose value as read lies within the
// tolerance and proves nothing. The runs are simulated by other code (simulated_analyses.h).
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "evaluation/analysis_result.h"
#include "evaluation/results/evaluation.h"
#include "record/tasks/run.h"
#include "record/tasks/settings.h"
#include "tests/evaluation/points_run.h"
#include "tests/evaluation/simulated_analyses.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using core::kDegree;
using core::kMicrometre;
using record::Form;
using record::RunRecord;
using record::SpindleTask;
using ::testing::HasSubstr;

constexpr const char* kSimple = "simple-acceptance";
constexpr const char* kIso = "iso-14253-1";

FeatureResult judged(RunRecord run, const std::string& rule,
                     std::vector<record::Characteristic> characteristics) {
  run.header.decision_rule = rule;
  run.features.at(0).characteristics = std::move(characteristics);
  return evaluated(run).features.at(0);
}

CharacteristicResult judged_one(const RunRecord& run, const std::string& rule, Form form,
                                double tolerance_um) {
  const FeatureResult result = judged(run, rule, {asked(form, tolerance_um)});
  EXPECT_FALSE(result.failure) << result.failure->what;
  return result.characteristics.at(0);
}

/// All gates of a result are listed, and those that did not pass say why.
void expect_listed(const FeatureResult& result) {
  EXPECT_FALSE(result.gates.empty());
  for (const Gate& gate : result.gates) {
    SCOPED_TRACE(gate.code);
    EXPECT_EQ(gate.code.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"),
              std::string::npos);
    EXPECT_FALSE(gate.code.empty());
    EXPECT_FALSE(gate.condition.empty());
    EXPECT_EQ(gate.outcome == Gate::Outcome::kPassed, gate.reason.empty());
  }
}

/// The gate with this code fails, and the values are void for the reason of a gate that fails.
void expect_void(const FeatureResult& result, const std::string& code) {
  expect_listed(result);
  std::vector<const Gate*> failed;
  for (const Gate& gate : result.gates) {
    const bool fails =
        gate.outcome == Gate::Outcome::kVoids || gate.outcome == Gate::Outcome::kBounds;
    if (fails) failed.push_back(&gate);
  }
  EXPECT_TRUE(std::any_of(failed.begin(), failed.end(),
                          [&](const Gate* gate) { return gate->code == code; }))
      << "no gate " << code << " failed";
  for (const CharacteristicResult& c : result.characteristics) {
    SCOPED_TRACE(c.characteristic.id);
    EXPECT_EQ(c.verdict, Verdict::kVoid) << c.reason;
    EXPECT_TRUE(std::any_of(failed.begin(), failed.end(), [&](const Gate* gate) {
      return c.reason.english().find(gate->reason.english()) != std::string::npos;
    })) << c.reason;
  }
}

// ---- A rule about the whole surface -------------------------------------------------------------

TEST(WholeSurface, IsNotJudgedByTheIntervalOfThePoints) {
  record::WheelTask task;
  auto& influences = task.uncertainty.emplace();
  influences.point_um = declared(0.4);
  influences.axis_um = declared(0.5);
  Normals draws(1);
  RunRecord run = wheel_run(worked_wheel(whole_turn()), task, draws);
  EXPECT_EQ(judged_one(run, kIso, Form::kRunOut, 20.0).verdict, Verdict::kConforms);
  run.settings.push_back({"decision_rule/measurand", std::nullopt, "whole-surface"});
  const CharacteristicResult whole = judged_one(run, kIso, Form::kRunOut, 20.0);
  EXPECT_EQ(whole.verdict, Verdict::kVoid);
  EXPECT_THAT(whole.reason.english(), HasSubstr("needs the interval of the whole surface"));
  EXPECT_EQ(judged_one(run, kSimple, Form::kRunOut, 20.0).verdict, Verdict::kConforms);
}

// ---- Run-out from a short arc -------------------------------------------------------------------

record::WheelTask declared_wheel() {
  record::WheelTask out;
  auto& influences = out.uncertainty.emplace();
  influences.point_um = declared(0.4);
  influences.axis_um = declared(0.5);
  return out;
}

/// Worked case W-2: eight points from 240 to 300 deg.
RunRecord arc_run(const record::WheelTask& task) {
  Normals draws(2);
  return wheel_run(worked_wheel(short_arc()), task, draws);
}

TEST(ShortArc, HasTheNumbersOfTheWorkedCase) {
  const auto result = judged_one(arc_run(declared_wheel()), kSimple, Form::kRunOut, 10.0);
  ASSERT_TRUE(result.value);
  EXPECT_NEAR(result.value->value_mm() / kMicrometre, 5.651, 5e-4);
}

TEST(ShortArc, ProvesNoRunOutOfTheWholeTurn) {
  for (const char* rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    expect_void(judged(arc_run(declared_wheel()), rule, {asked(Form::kRunOut, 10.0)}), "gap");
    for (const double tolerance_um : {5.7, 7.0, 11.7, 20.0, 100.0}) {
      const auto result = judged_one(arc_run(declared_wheel()), rule, Form::kRunOut, tolerance_um);
      EXPECT_EQ(result.verdict, Verdict::kVoid) << tolerance_um << " um: " << result.reason;
    }
  }
  expect_void(judged(arc_run({}), kSimple, {asked(Form::kRunOut, 10.0)}), "gap");
}

TEST(ShortArc, ProvesWhatItSeesOfTheRunOut) {
  for (const char* rule : {kSimple, kIso}) {
    const auto result = judged_one(arc_run(declared_wheel()), rule, Form::kRunOut, 4.0);
    EXPECT_EQ(result.verdict, Verdict::kDoesNotConform) << rule << ": " << result.reason;
  }
  // The lower end of the interval is 4.2 um: 5 um is not disproved.
  const auto between = judged_one(arc_run(declared_wheel()), kIso, Form::kRunOut, 5.0);
  EXPECT_EQ(between.verdict, Verdict::kVoid) << between.reason;
}

TEST(ShortArc, IsToldFromTheWholeTurn) {
  Normals draws(1);
  const RunRecord whole = wheel_run(worked_wheel(whole_turn()), declared_wheel(), draws);
  for (const char* rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    const FeatureResult result = judged(whole, rule, {asked(Form::kRunOut, 20.0)});
    expect_listed(result);
    const CharacteristicResult& run_out = result.characteristics.at(0);
    EXPECT_EQ(run_out.verdict, Verdict::kConforms) << run_out.reason;
    ASSERT_TRUE(run_out.value);
    EXPECT_NEAR(run_out.value->value_mm() / kMicrometre, 11.335, 5e-4);
    EXPECT_EQ(judged_one(whole, rule, Form::kRunOut, 8.0).verdict, Verdict::kDoesNotConform);
  }
  // 11.335 um as read, at most 13.25; what is missing between the points is below a tenth of 12 um.
  EXPECT_EQ(judged_one(whole, kIso, Form::kRunOut, 12.0).verdict, Verdict::kUndecided);
}

// ---- A proud point and the robust rule ----------------------------------------------------------

/// Worked case W-3: the fifth of 16 points 45 um proud.
RunRecord proud_run(record::Switch robust, record::WheelTask task) {
  Normals draws(3);
  SimulatedWheel world = worked_wheel(whole_turn());
  world.proud_point = 4;
  world.proud_um = 45.0;
  task.robust = robust;
  return wheel_run(world, task, draws);
}

TEST(ProudPoint, IsRunOutWithAndWithoutTheRobustRule) {
  for (const record::Switch robust : {record::Switch::kOff, record::Switch::kOn}) {
    for (const char* rule : {kSimple, kIso}) {
      for (const double tolerance_um : {12.0, 20.0, 40.0}) {
        SCOPED_TRACE(std::string(name_of(robust)) + " " + rule);
        const auto result =
            judged_one(proud_run(robust, declared_wheel()), rule, Form::kRunOut, tolerance_um);
        EXPECT_EQ(result.verdict, Verdict::kDoesNotConform)
            << tolerance_um << " um: " << result.reason;
        ASSERT_TRUE(result.value);
        EXPECT_NEAR(result.value->value_mm() / kMicrometre, 47.52, 5e-3);
      }
    }
  }
}

TEST(ProudPoint, IsRoundnessWithAndWithoutTheRobustRule) {
  for (const record::Switch robust : {record::Switch::kOff, record::Switch::kOn}) {
    for (const record::Reference reference :
         {record::Reference::kLeastSquares, record::Reference::kMinimumZone}) {
      record::Characteristic roundness = asked(Form::kRoundness, 20.0);
      roundness.reference = reference;
      const FeatureResult result = judged(proud_run(robust, {}), kSimple, {roundness});
      EXPECT_EQ(result.characteristics.at(0).verdict, Verdict::kDoesNotConform)
          << name_of(robust) << ", " << name_of(reference) << ": "
          << result.characteristics.at(0).reason;
    }
  }
}

// ---- A wrong gain of a probe --------------------------------------------------------------------

constexpr auto kLayoutA = SpindleTask::Layout::kPublishedA;

/// Worked case S-1 with noise: layout A, the gain of P2 wrong by 1 %.
SimulatedSpindle wrong_gain() {
  SimulatedSpindle out = worked_spindle(kLayoutA);
  out.gains_1[1] = 1.01;
  out.turns = 1;
  out.samples_per_turn = 1024;
  out.noise_um = 0.005;
  return out;
}

RunRecord probed_run(const SimulatedSpindle& world, std::optional<double> gain_1,
                     std::optional<double> angle_deg) {
  SpindleTask task = spindle_task(kLayoutA, world);
  if (gain_1) {
    auto& influences = task.uncertainty.emplace();
    influences.noise_um = declared(world.noise_um);
    influences.gain_1 = declared(*gain_1);
    influences.angle_deg = declared(*angle_deg);
  }
  Normals draws(1);
  return spindle_run(world, task, draws);
}

TEST(WrongGain, IsSimulatedAsInTheWorkedCase) {
  // Its readings are exact; these are to first order, which leaves some nanometres.
  const SimulatedSpindle world = wrong_gain();
  EXPECT_NEAR(world.reading_um(0, 0.0), 13.227232, 5e-3);
  EXPECT_NEAR(world.reading_um(1, 0.0), 3.045276, 5e-3);
  EXPECT_NEAR(world.reading_um(2, 0.0), -8.133098, 5e-3);
  EXPECT_NEAR(world.reading_um(0, 0.351562 * kDegree), 13.263853, 5e-3);
  EXPECT_NEAR(true_synchronous_um(world), 2.949, 2e-3);
  EXPECT_NEAR(true_roundness_um(world), 12.3136, 1e-4);
  EXPECT_NEAR(true_roundness_rms_um(world), 2.6825, 1e-4);
}

TEST(WrongGain, IsVoidWhereTheCertificateRulesItOut) {
  const RunRecord run = probed_run(wrong_gain(), 0.001, 0.01);
  for (const char* rule : {kSimple, kIso}) {
    for (const double tolerance_um : {2.0, 3.3, 5.0}) {  // the motion reads 3.7 um, and is 2.9 um
      SCOPED_TRACE(rule);
      expect_void(judged(run, rule, {asked(Form::kMotionSynchronous, tolerance_um)}),
                  "first-harmonic");
    }
    expect_void(judged(run, rule, {asked(Form::kRoundness, 20.0)}), "first-harmonic");
  }
}

TEST(WrongGain, IsVoidWhereNothingIsDeclared) {
  const RunRecord run = probed_run(wrong_gain(), std::nullopt, std::nullopt);
  for (const double tolerance_um : {2.0, 3.3, 5.0}) {
    expect_void(judged(run, kSimple, {asked(Form::kMotionSynchronous, tolerance_um)}),
                "first-harmonic");
  }
}

TEST(WrongGain, IsCorrectedWhereTheCertificateAllowsIt) {
  const RunRecord run = probed_run(wrong_gain(), 0.005, 0.25);
  const auto wide = judged_one(run, kIso, Form::kMotionSynchronous, 5.0);
  EXPECT_EQ(wide.verdict, Verdict::kConforms) << wide.reason;
  ASSERT_TRUE(wide.value);
  const double truth_mm = true_synchronous_um(wrong_gain()) * kMicrometre;
  EXPECT_GT(wide.value->value_mm(), 3.4e-3) << "the value as measured is wrong";
  ASSERT_NE(wide.value->statement(), nullptr) << wide.value->uncertainty().why();
  EXPECT_LT(wide.value->statement()->low_mm, truth_mm);
  EXPECT_GT(wide.value->statement()->high_mm, truth_mm);
  EXPECT_LT(wide.value->statement()->high_mm, 3.4e-3);
  const auto between = judged_one(run, kIso, Form::kMotionSynchronous, 3.4);
  EXPECT_EQ(between.verdict, Verdict::kUndecided) << "it was read above: " << between.reason;
  const auto tight = judged_one(run, kIso, Form::kMotionSynchronous, 2.0);
  EXPECT_EQ(tight.verdict, Verdict::kDoesNotConform) << tight.reason;
}

TEST(WrongGain, IsToldFromTheRightOne) {
  SimulatedSpindle right = wrong_gain();
  right.gains_1[1] = 1.0;
  const FeatureResult result =
      judged(probed_run(right, 0.001, 0.01), kIso, {asked(Form::kMotionSynchronous, 5.0)});
  expect_listed(result);
  EXPECT_EQ(result.characteristics.at(0).verdict, Verdict::kConforms)
      << result.characteristics.at(0).reason;
}

TEST(WrongGain, CannotBeSeenWithoutEccentricity) {
  SimulatedSpindle centred = wrong_gain();
  centred.eccentricity_um = 0.0;
  centred.noise_um = 0.02;  // hides what the motion itself puts into the first harmonic
  // Nothing contradicts; nothing is known of gains and places either, so there is no verdict.
  for (const char* rule : {kSimple, kIso}) {
    const FeatureResult result = judged(probed_run(centred, std::nullopt, std::nullopt), rule,
                                        {asked(Form::kMotionSynchronous, 5.0)});
    expect_listed(result);
    EXPECT_EQ(result.characteristics.at(0).verdict, Verdict::kVoid)
        << result.characteristics.at(0).reason;
    EXPECT_TRUE(std::any_of(result.gates.begin(), result.gates.end(), [](const Gate& gate) {
      return gate.code == "k1-blind" && gate.outcome == Gate::Outcome::kVoids;
    }));
  }
}

// ---- A warm calibration -------------------------------------------------------------------------

std::vector<record::Characteristic> residuals() {
  return {asked(Form::kFixtureResidual, 5.0), asked(Form::kFixtureResidualRms, 2.5)};
}

TEST(WarmCalibration, IsVoid) {
  for (const char* rule : {kSimple, kIso}) {
    Normals draws(1);
    const FeatureResult result = judged(ball_plate_run(35.0, draws), rule, residuals());
    ASSERT_TRUE(result.analysis) << (result.failure ? result.failure->what : "");
    for (const CharacteristicResult& c : result.characteristics) {
      EXPECT_EQ(c.verdict, Verdict::kVoid) << c.characteristic.id << ": " << c.reason;
      EXPECT_THAT(c.reason.english(), HasSubstr("35.00 degC"));
    }
    expect_listed(result);
  }
}

TEST(WarmCalibration, IsToldFromOneWithinTheLimits) {
  Normals draws(1);
  const FeatureResult result = judged(ball_plate_run(20.1, draws), kSimple, residuals());
  ASSERT_TRUE(result.analysis) << (result.failure ? result.failure->what : "");
  for (const CharacteristicResult& c : result.characteristics) {
    EXPECT_EQ(c.verdict, Verdict::kConforms) << c.characteristic.id << ": " << c.reason;
  }
}

TEST(WarmCalibration, IsVoidWhereOneTouchIsWarm) {
  Normals draws(1);
  RunRecord run = ball_plate_run(20.1, draws);
  run.touches.back().temperature_degC = 22.5;
  const FeatureResult result = judged(run, kSimple, residuals());
  for (const CharacteristicResult& c : result.characteristics) {
    EXPECT_EQ(c.verdict, Verdict::kVoid) << c.characteristic.id << ": " << c.reason;
  }
}

/// A cylinder of some 10 um, touched on the fixture of a ball plate, with its calibration.
RunRecord inspection_with(const fixture::Calibration& calibration, double calibrated_degC) {
  nlohmann::json text = nlohmann::json::parse(fixture::calibration_text(calibration));
  text.at("temperature_degC") = calibrated_degC;
  Normals draws(1);
  RunRecord out = points_run(rough_part(3, 4, 7, core::kTwoPi), 4);
  out.features.at(0).strategy = record::Strategy::kGuided;
  record::Characteristic cylindricity = asked(Form::kCylindricity, 50.0);
  cylindricity.reference = record::Reference::kMinimumZone;
  out.features.at(0).characteristics = {cylindricity};
  for (record::Touch& touch : out.touches) touch.temperature_degC = 20.0;
  const RunRecord plate = ball_plate_run(20.1, draws);
  for (record::Touch touch : plate.touches) {
    if (touch.purpose != record::Touch::Purpose::kQualification) continue;
    touch.id += 1000;
    out.touches.push_back(touch);
  }
  out.header.temperature_min_degC = 18.0;
  out.header.temperature_max_degC = 22.0;
  out.header.started_utc = "2026-11-23T10:00:00Z";
  out.artefact = plate.artefact;
  auto said = record::task_of<record::FixtureSettings>(plate.settings, "fixture/");
  said->calibration = text.dump();
  out.settings = record::settings_of_task(*said, "fixture/");
  return out;
}

TEST(WarmCalibration, IsNotBelievedByAnInspection) {
  Normals draws(1);
  const FeatureResult plate = judged(ball_plate_run(20.1, draws), kSimple, residuals());
  ASSERT_TRUE(plate.analysis) << (plate.failure ? plate.failure->what : "");
  const auto& calibration = std::get<RotaryResult>(plate.analysis->found).calibration;

  const Evaluation good = evaluated(inspection_with(calibration, 20.1));
  const CharacteristicResult& trusted = good.features.at(0).characteristics.at(0);
  EXPECT_EQ(trusted.verdict, Verdict::kConforms) << trusted.reason;

  const Evaluation warm = evaluated(inspection_with(calibration, 35.0));
  ASSERT_TRUE(warm.fixture);
  EXPECT_TRUE(warm.fixture->invalid);
  const CharacteristicResult& refused = warm.features.at(0).characteristics.at(0);
  EXPECT_EQ(refused.verdict, Verdict::kVoid);
  EXPECT_THAT(refused.reason.english(), HasSubstr("35.00 degC"));
}

// ---- What is not declared -----------------------------------------------------------------------

TEST(NotDeclared, MakesOnlyTheLineVoidThatNeedsAnInterval) {
  Normals draws(1);
  const RunRecord run = wheel_run(worked_wheel(whole_turn()), {}, draws);
  record::Characteristic simple = asked(Form::kRunOut, 20.0);
  simple.id = "by simple acceptance";
  simple.indication.decision_rule.emplace();  // its default
  const FeatureResult result = judged(run, kIso, {asked(Form::kRunOut, 20.0), simple});
  const CharacteristicResult& by_interval = result.characteristics.at(0);
  EXPECT_EQ(by_interval.verdict, Verdict::kVoid);
  EXPECT_THAT(by_interval.reason.english(), HasSubstr("declare"));
  EXPECT_EQ(result.characteristics.at(1).verdict, Verdict::kConforms)
      << result.characteristics.at(1).reason;
}

TEST(NotDeclared, LeavesOtherFeaturesTheirVerdict) {
  Normals draws(1);
  RunRecord run = wheel_run(worked_wheel(whole_turn()), declared_wheel(), draws);
  Normals others(2);
  const RunRecord other = wheel_run(worked_wheel(whole_turn()), {}, others);
  run.header.decision_rule = kIso;
  run.features.push_back(other.features.at(0));
  run.series.push_back(other.series.at(0));
  run.series.back().feature = 1;
  for (record::Feature& feature : run.features) {
    feature.characteristics = {asked(Form::kRunOut, 20.0)};
  }
  const Evaluation evaluation = evaluated(run);
  EXPECT_EQ(evaluation.features.at(0).characteristics.at(0).verdict, Verdict::kConforms);
  EXPECT_EQ(evaluation.features.at(1).characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_EQ(evaluation.verdict, Verdict::kVoid);
}

}  // namespace
}  // namespace rondure::reports
