// Intervals and gates of a wheel: the worked cases W-1 to W-3 of the specification, and the false
// acceptances that must not come back.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "evaluation/wheel/result.h"
#include "record/run_record.h"
#include "record/tasks/settings.h"
#include "record/tasks/wheel.h"
#include "tests/core/full.h"
#include "tests/fit/wheel_cases.h"

namespace rondure::evaluation {
namespace {

using record::DeclaredInfluence;
using record::Influence;
using record::WheelTask;
using ::testing::HasSubstr;

// Ends of intervals scatter with the draws: of 2000 trials by 0.06 um where u is 1 um.
constexpr double kEnds_um = 0.25;
constexpr std::string_view kSimple = "simple-acceptance";
constexpr std::string_view kIso = "iso-14253-1";

const std::vector<double> kAllRound = test::even_degrees(16, 0.0, 22.5);
const std::vector<double> kArc = test::even_degrees(8, 240.0, 60.0 / 7.0);

record::Characteristic asked(record::Form form, double tolerance_um) {
  record::Characteristic out;
  out.id = "c";
  out.form = form;
  out.tolerance_mm = tolerance_um * 1e-3;
  return out;
}

WheelTask task_of(const test::SpecifiedWheel& wheel) {
  WheelTask out;
  out.nominal_radius_mm = 50.0;
  out.axis_x_mm = wheel.axis_mm.x();
  out.axis_z_mm = wheel.axis_mm.y();
  out.uncertainty.emplace();
  out.uncertainty->point_um = DeclaredInfluence{test::SpecifiedWheel::kPoint_mm * 1e3};
  out.uncertainty->axis_um = DeclaredInfluence{test::SpecifiedWheel::kAxis_mm * 1e3};
  return out;
}

record::RunRecord run_of(const test::Points2& points_mm, const WheelTask& task,
                         std::vector<record::Characteristic> characteristics,
                         std::string_view rule) {
  record::RunRecord run;
  run.header.run_id = "wheel";
  run.header.decision_rule = rule;
  run.ending = "finished";
  record::Feature feature;
  feature.id = "wheel";
  feature.shape = record::Shape::kWheel;
  feature.strategy = record::Strategy::kSeries;
  feature.settings = record::settings_of_task(task);
  feature.characteristics = std::move(characteristics);
  run.features = {feature};
  record::Series data;
  data.columns = {{"x", "mm"}, {"z", "mm"}};
  for (const auto& p : points_mm) data.values.insert(data.values.end(), {p.x(), p.y()});
  run.series = {data};
  return run;
}

FeatureResult evaluated_wheel(const record::RunRecord& run) {
  auto evaluation = evaluate(run);
  EXPECT_TRUE(evaluation) << (evaluation ? "" : evaluation.error().what);
  if (!evaluation) return {};
  const FeatureResult& feature = evaluation->features.at(0);
  EXPECT_FALSE(feature.failure) << feature.failure->what;
  return feature;
}

FeatureResult evaluated_wheel(const test::SpecifiedWheel& wheel, const WheelTask& task,
                              record::Form form, double tolerance_um, std::string_view rule) {
  return evaluated_wheel(run_of(wheel.points_mm, task, {asked(form, tolerance_um)}, rule));
}

struct LobedArc {
  test::Points2 points_mm;
  double radius_mm = 0.0;
};

/// 24 points on an arc of a wheel with lobes of 1.2 um (2) and 0.8 um (3), all places random.
LobedArc lobed_arc(std::uint64_t seed, double arc_deg, double point_mm) {
  core::KeyedNoise noise(seed, {140});
  const double first = core::kTwoPi * noise.uniform();
  const double two = core::kTwoPi * noise.uniform();
  const double three = core::kTwoPi * noise.uniform();
  LobedArc out{{}, test::SpecifiedWheel::kRadius_mm};
  for (int i = 0; i < 24; ++i) {
    const double a = first + arc_deg * core::kDegree * i / 23.0;
    const double r = out.radius_mm + 1.2e-3 * std::cos(2.0 * a - two) +
                     0.8e-3 * std::cos(3.0 * a - three) + point_mm * noise.normal();
    out.points_mm.emplace_back(12.0 + r * std::cos(a), -7.0 + r * std::sin(a));
  }
  return out;
}

const UncertaintyStatement& statement(const CharacteristicResult& result) {
  static const UncertaintyStatement kNone;
  EXPECT_TRUE(result.value && result.value->statement() != nullptr) << result.reason;
  return result.value && result.value->statement() ? *result.value->statement() : kNone;
}

const Gate* wheel_gate(const FeatureResult& feature, std::string_view code) {
  const auto found =
      std::ranges::find_if(feature.gates, [&](const Gate& gate) { return gate.code == code; });
  EXPECT_NE(found, feature.gates.end()) << code;
  return found == feature.gates.end() ? nullptr : &*found;
}

TEST(WheelInterval, TheGeneratorGivesThePointsThatTheSpecificationPrints) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  EXPECT_NEAR(wheel.points_mm[0].x(), 61.9842168, 1e-7);
  EXPECT_NEAR(wheel.points_mm[0].y(), -7.0028679, 1e-7);
  EXPECT_NEAR(wheel.points_mm[1].x(), 58.1779539, 1e-7);
  EXPECT_NEAR(wheel.points_mm[1].y(), 12.1247066, 1e-7);
  EXPECT_NEAR(wheel.axis_mm.x(), 12.0035335, 1e-7);
  EXPECT_NEAR(wheel.axis_mm.y(), -7.0003755, 1e-7);
}

// W-1 and W-2: the truth at the points and of the body, without noise.
TEST(WheelInterval, TheTruthIsThatOfTheSpecification) {
  const auto run_out_um = [](const std::vector<double>& degrees) {
    const auto wheel = test::specified_wheel(1, degrees);
    fit::WheelOptions options;
    options.axis_mm = wheel.true_axis_mm;
    const auto found = fit::measure_wheel(wheel.true_points_mm, options);
    return found ? found->runout->fim_mm * 1e3 : 0.0;
  };
  EXPECT_NEAR(run_out_um(kAllRound), 11.557, 5e-4);
  EXPECT_NEAR(run_out_um(test::even_degrees(720, 0.0, 0.5)), 11.732, 1e-3);
}

TEST(WheelInterval, W1SixteenPointsAllRound) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  const WheelTask task = task_of(wheel);
  for (const std::string_view rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    const auto feature = evaluated_wheel(wheel, task, record::Form::kRunOut, 20.0, rule);
    const auto& fim = feature.characteristics.at(0);
    EXPECT_EQ(fim.verdict, Verdict::kConforms) << fim.reason;
    EXPECT_NEAR(fim.value_mm().value() * 1e3, 11.335, 1e-3);
    const UncertaintyStatement& said = statement(fim);
    EXPECT_NEAR(said.low_mm * 1e3, 9.02, kEnds_um);
    EXPECT_NEAR(said.high_mm * 1e3, 13.25, kEnds_um);
    EXPECT_NEAR(said.estimate_mm * 1e3, 11.11, 0.1);
    // The truth at the points.
    EXPECT_LT(said.low_mm * 1e3, 11.557);
    EXPECT_GT(said.high_mm * 1e3, 11.557);
    // The bound of the body is 0.645 um; of the noise of seven orders a quarter is left.
    const Gate* loss = wheel_gate(feature, "loss-between-points");
    ASSERT_NE(loss, nullptr);
    EXPECT_GT(loss->found.value(), 0.645);
    EXPECT_LT(loss->found.value(), 1.1);
    EXPECT_NEAR(loss->limit.value(), 2.0, 1e-12);
    EXPECT_EQ(loss->outcome, Gate::Outcome::kPassed);
  }
}

TEST(WheelInterval, W1TheRuleOfTheIntervalAcceptsLessThanTheValueAsMeasured) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  const WheelTask task = task_of(wheel);
  const auto verdict = [&](record::Form form, double tolerance_um, std::string_view rule) {
    return evaluated_wheel(wheel, task, form, tolerance_um, rule).characteristics.at(0).verdict;
  };
  // 11.335 um as read, at most 13.25.
  EXPECT_EQ(verdict(record::Form::kRunOut, 12.0, kSimple), Verdict::kUndecided);
  EXPECT_EQ(verdict(record::Form::kRunOut, 12.0, kIso), Verdict::kUndecided);
  const auto dense = test::specified_wheel(1, test::even_degrees(64, 0.0, 5.625));
  const auto of_dense = [&](double tolerance_um, std::string_view rule) {
    return evaluated_wheel(dense, task_of(dense), record::Form::kRunOut, tolerance_um, rule)
        .characteristics.at(0);
  };
  const auto read = of_dense(60.0, kIso);
  EXPECT_EQ(read.verdict, Verdict::kConforms) << read.reason;
  const double value_um = read.value_mm().value() * 1e3;
  const double high_um = statement(read).high_mm * 1e3;
  ASSERT_GT(high_um, value_um + 0.2);
  const double between_um = 0.5 * (value_um + high_um);
  EXPECT_EQ(of_dense(between_um, kSimple).verdict, Verdict::kUndecided) << "read within";
  EXPECT_EQ(of_dense(high_um + 0.01, kSimple).verdict, Verdict::kConforms);
  EXPECT_EQ(of_dense(between_um, kIso).verdict, Verdict::kUndecided);
  // |R - 50 mm| is 16.877 um, u 0.100 um.
  EXPECT_EQ(verdict(record::Form::kRadius, 17.2, kSimple), Verdict::kConforms);
  EXPECT_EQ(verdict(record::Form::kRadius, 17.0, kSimple), Verdict::kUndecided);
  EXPECT_EQ(verdict(record::Form::kRadius, 17.0, kIso), Verdict::kUndecided);
  EXPECT_EQ(verdict(record::Form::kRadius, 17.2, kIso), Verdict::kConforms);
  EXPECT_EQ(verdict(record::Form::kRadius, 16.5, kIso), Verdict::kDoesNotConform);
}

/// R - 50 mm of W-1 is -16.877 um, u 0.100 um.
TEST(WheelInterval, W1TheSignOfTheDepartureCounts) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  const auto judged = [&](double lower_um, double upper_um, std::string_view rule) {
    record::Characteristic radius = asked(record::Form::kRadius, upper_um);
    radius.lower_mm = lower_um * 1e-3;
    return evaluated_wheel(run_of(wheel.points_mm, task_of(wheel), {radius}, rule))
        .characteristics.at(0);
  };
  const CharacteristicResult within = judged(-20.0, 5.0, kIso);
  EXPECT_EQ(within.verdict, Verdict::kConforms) << within.reason;
  EXPECT_NEAR(within.value_mm().value() * 1e3, -16.877, 1e-3);
  const UncertaintyStatement& said = statement(within);
  EXPECT_FALSE(said.at_most);
  EXPECT_NEAR(said.estimate_mm * 1e3, -16.877, 0.02);
  EXPECT_NEAR(said.low_mm * 1e3, -16.877 - 1.96 * 0.1, 0.03);
  EXPECT_NEAR(said.high_mm * 1e3, -16.877 + 1.96 * 0.1, 0.03);
  for (const std::string_view rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    EXPECT_EQ(judged(-5.0, 20.0, rule).verdict, Verdict::kDoesNotConform);
    EXPECT_EQ(judged(-16.5, 20.0, rule).verdict, Verdict::kDoesNotConform);
    EXPECT_EQ(judged(-17.2, 17.2, rule).verdict, Verdict::kConforms);
  }
  EXPECT_EQ(judged(-17.0, 17.0, kSimple).verdict, Verdict::kUndecided);
  EXPECT_EQ(judged(-17.0, 17.0, kIso).verdict, Verdict::kUndecided);
  EXPECT_EQ(judged(-50.0, -16.8, kIso).verdict, Verdict::kUndecided);
}

TEST(WheelInterval, W1RadiusWithWhatIsDeclaredOfIt) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(wheel);
  const auto u_um = [&] {
    const auto feature = evaluated_wheel(wheel, task, record::Form::kRadius, 30.0, kIso);
    return statement(feature.characteristics.at(0)).standard_uncertainty_mm * 1e3;
  };
  const auto feature = evaluated_wheel(wheel, task, record::Form::kRadius, 30.0, kIso);
  const auto& result = std::get<WheelResult>(feature.analysis->found);
  EXPECT_NEAR(result.evaluation.wheel.radius_mm, 49.983123, 1e-6);
  EXPECT_NEAR(result.evaluation.wheel.radius_uncertainty_mm * 1e3, 0.100, 1e-3);
  EXPECT_NEAR(u_um(), 0.100, 0.006);
  task.uncertainty->scale_ppm = DeclaredInfluence{20.0};
  EXPECT_NEAR(u_um(), std::hypot(0.1, 20e-6 * 49.983e3), 0.05);
  using Distribution = DeclaredInfluence::Distribution;
  task.uncertainty->scale_ppm.reset();
  task.uncertainty->threshold_um = DeclaredInfluence{1.5, Distribution::kRectangular};
  EXPECT_NEAR(u_um(), std::hypot(0.1, 1.5 / std::sqrt(3.0)), 0.05);
}

/// A run whose points carry a temperature.
record::RunRecord at_degC(record::RunRecord run, double degC) {
  record::Series& data = run.series.at(0);
  std::vector<double> values;
  for (std::size_t i = 0; i < data.rows(); ++i) {
    values.insert(values.end(), {data.values[2 * i], data.values[2 * i + 1], degC});
  }
  data.columns.push_back({"temperature_degC", "degC"});
  data.values = std::move(values);
  return run;
}

// Both signs of the departure count: a wheel of nominal radius is held to +-T.
TEST(WheelInterval, ADepartureIsHeldToBothSides) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(wheel);
  task.nominal_radius_mm = 49.983123;
  task.uncertainty->threshold_um = DeclaredInfluence{1.0};
  const auto verdict = [&](double tolerance_um) {
    const auto run =
        run_of(wheel.points_mm, task, {asked(record::Form::kRadius, tolerance_um)}, kIso);
    return evaluated_wheel(at_degC(run, 20.0)).characteristics.at(0).verdict;
  };
  // 1.96 u is 1.97 um on each side; the trials folded at 0 end at 2.25 um.
  EXPECT_EQ(verdict(1.9), Verdict::kUndecided);
  EXPECT_EQ(verdict(2.5), Verdict::kConforms);
}

// R 49.983123 mm at 30 degC is 4.0 um less at 20 degC with 8e-6/K: R / (1 + 8e-5). A nominal radius
// that it reads exactly is missed by that, and a tolerance of 3 um with it.
TEST(WheelInterval, ARadiusIsJudgedAt20DegC) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(wheel);
  task.nominal_radius_mm = 49.983123;
  const auto judged = [&](double degC, double tolerance_um) {
    return evaluated_wheel(at_degC(
        run_of(wheel.points_mm, task, {asked(record::Form::kRadius, tolerance_um)}, kSimple),
        degC));
  };
  const FeatureResult unknown = judged(30.0, 3.0);
  const Gate* const gate = wheel_gate(unknown, "length-scale");
  ASSERT_NE(gate, nullptr);
  EXPECT_EQ(gate->outcome, Gate::Outcome::kVoids);
  EXPECT_NEAR(*gate->found, 3.9986, 1e-3);
  EXPECT_NEAR(*gate->limit, 0.75, 1e-9);
  EXPECT_EQ(unknown.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(unknown.characteristics.at(0).reason.english(), HasSubstr("30.00 degC"));
  EXPECT_EQ(judged(20.5, 3.0).characteristics.at(0).verdict, Verdict::kConforms);

  task.expansion_per_K = 8e-6;
  const CharacteristicResult corrected = judged(30.0, 3.0).characteristics.at(0);
  EXPECT_EQ(corrected.verdict, Verdict::kDoesNotConform) << corrected.reason;
  ASSERT_TRUE(corrected.value);
  EXPECT_NEAR(corrected.value->value_mm() * 1e3, 49983.123 * (1.0 - 1.0 / 1.00008), 2e-3);
  EXPECT_EQ(judged(30.0, 5.0).characteristics.at(0).verdict, Verdict::kConforms);
  const FeatureResult without =
      evaluated_wheel(run_of(wheel.points_mm, task, {asked(record::Form::kRadius, 3.0)}, kSimple));
  EXPECT_EQ(without.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(without.characteristics.at(0).reason.english(), HasSubstr("was not recorded"));
}

// 5 K are 2 um of a radius of 50 mm. Without a temperature nothing says that they were not there.
TEST(WheelInterval, ARadiusWithoutTemperatureIsJudgedOnlyWhereItMattersLittle) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(wheel);
  task.nominal_radius_mm = 49.983;
  for (const std::string_view rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    const auto narrow = evaluated_wheel(wheel, task, record::Form::kRadius, 7.9, rule);
    EXPECT_EQ(narrow.characteristics.at(0).verdict, Verdict::kVoid);
    EXPECT_THAT(narrow.characteristics.at(0).reason.english(), HasSubstr("was not recorded"));
    EXPECT_NEAR(wheel_gate(narrow, "length-scale")->found.value(), 2.0, 0.01);
    EXPECT_EQ(evaluated_wheel(wheel, task, record::Form::kRadius, 8.1, rule)
                  .characteristics.at(0)
                  .verdict,
              Verdict::kConforms);
  }
}

// u: R dT u_alpha = 49.983 mm x 10 K x 1e-6/K = 0.50 um, R alpha u_T = 49.983 mm x 8e-6/K x 1 K =
// 0.40 um, and 0.10 um of the points.
TEST(WheelInterval, TheCorrectionTo20DegCHasAnUncertainty) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(wheel);
  task.expansion_per_K = 8e-6;
  task.uncertainty->expansion_per_K = DeclaredInfluence{1e-6};
  task.uncertainty->temperature_K = DeclaredInfluence{1.0};
  const FeatureResult feature = evaluated_wheel(
      at_degC(run_of(wheel.points_mm, task, {asked(record::Form::kRadius, 60.0)}, kIso), 30.0));
  EXPECT_NEAR(statement(feature.characteristics.at(0)).standard_uncertainty_mm * 1e3,
              std::hypot(0.1, std::hypot(0.49983, 0.39986)), 0.03);
}

// W-2, the first false acceptance: 8 points on 60 deg read 5.65 um of 11.73.
TEST(WheelInterval, W2AnArcNeverConforms) {
  const auto wheel = test::specified_wheel(2, kArc);
  const WheelTask task = task_of(wheel);
  for (const std::string_view rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    const auto feature = evaluated_wheel(wheel, task, record::Form::kRunOut, 10.0, rule);
    const auto& fim = feature.characteristics.at(0);
    EXPECT_EQ(fim.verdict, Verdict::kVoid);
    EXPECT_THAT(fim.reason.english(), HasSubstr("300 deg of the turn unseen"));
    EXPECT_NEAR(fim.value_mm().value() * 1e3, 5.651, 1e-3);
    EXPECT_NEAR(statement(fim).low_mm * 1e3, 4.21, kEnds_um);
    EXPECT_NEAR(statement(fim).high_mm * 1e3, 6.82, kEnds_um);
    const Gate* gap = wheel_gate(feature, "gap");
    ASSERT_NE(gap, nullptr);
    EXPECT_NEAR(gap->found.value(), 300.0, 0.05);
    EXPECT_EQ(gap->outcome, Gate::Outcome::kBounds);
    EXPECT_EQ(
        evaluated_wheel(wheel, task, record::Form::kRunOut, 3.5, rule).characteristics[0].verdict,
        Verdict::kDoesNotConform);
    EXPECT_EQ(
        evaluated_wheel(wheel, task, record::Form::kRunOut, 4.0, rule).characteristics[0].verdict,
        Verdict::kDoesNotConform);
    for (const double tolerance_um : {7.0, 12.0, 50.0, 1000.0}) {
      SCOPED_TRACE(tolerance_um);
      for (const record::Form form : {record::Form::kRunOut, record::Form::kRoundness}) {
        EXPECT_EQ(evaluated_wheel(wheel, task, form, tolerance_um, rule).characteristics[0].verdict,
                  Verdict::kVoid);
      }
    }
  }
  const auto feature = evaluated_wheel(wheel, task, record::Form::kRadius, 30.0, kIso);
  const auto& m = std::get<WheelResult>(feature.analysis->found).evaluation.wheel;
  EXPECT_NEAR(m.radius_mm, 49.99242, 1e-5);
  EXPECT_NEAR(m.radius_uncertainty_mm * 1e3, 2.666, 2e-3);
  EXPECT_FALSE(m.effective_radius_mm());
}

// W-3, the second: a point 45 um proud, with and without the robust variant.
TEST(WheelInterval, W3AProudPointIsRunOut) {
  const auto wheel = test::specified_wheel(3, kAllRound, 4);
  WheelTask task = task_of(wheel);
  for (const record::Switch robust : {record::Switch::kOff, record::Switch::kOn}) {
    task.robust = robust;
    for (const std::string_view rule : {kSimple, kIso}) {
      SCOPED_TRACE(rule);
      const auto feature = evaluated_wheel(wheel, task, record::Form::kRunOut, 20.0, rule);
      const auto& fim = feature.characteristics.at(0);
      EXPECT_EQ(fim.verdict, Verdict::kDoesNotConform) << fim.reason;
      EXPECT_NEAR(fim.value_mm().value() * 1e3, 47.52, 0.01);
      EXPECT_NEAR(statement(fim).low_mm * 1e3, 46.2, kEnds_um);
      EXPECT_NEAR(statement(fim).high_mm * 1e3, 48.8, kEnds_um);
      const auto& result = std::get<WheelResult>(feature.analysis->found);
      EXPECT_EQ(result.evaluation.wheel.dropped.size(), robust == record::Switch::kOn ? 1U : 0U);
      EXPECT_NEAR(result.evaluation.wheel.runout->effective_radius_mm, 50.025416, 1e-6);
      const auto* effective = result.effective_radius.about(Measurand::kSampledPoints);
      ASSERT_NE(effective, nullptr) << result.effective_radius.why();
      EXPECT_LT(effective->low_mm, 50.025186);
      EXPECT_GT(effective->high_mm, 50.025186);
      EXPECT_LT(effective->high_mm - effective->low_mm, 4e-3);
      const auto round = evaluated_wheel(wheel, task, record::Form::kRoundness, 10.0, rule);
      EXPECT_EQ(round.characteristics[0].verdict, Verdict::kDoesNotConform);
    }
  }
}

// A hollow lowers the least distance only; it is kept, too.
TEST(WheelInterval, AChipIsRunOutWithTheRobustVariant) {
  auto wheel = test::specified_wheel(3, kAllRound);
  wheel.points_mm[4].y() -= 45e-3;
  WheelTask task = task_of(wheel);
  task.robust = record::Switch::kOn;
  const auto feature = evaluated_wheel(wheel, task, record::Form::kRunOut, 20.0, kIso);
  EXPECT_EQ(feature.characteristics.at(0).verdict, Verdict::kDoesNotConform);
  EXPECT_GT(feature.characteristics.at(0).value_mm().value() * 1e3, 40.0);
}

TEST(WheelInterval, ThereIsNoneOfWhatIsNotDeclared) {
  const auto wheel = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(wheel);
  const auto reason = [&](record::Form form) {
    const auto feature = evaluated_wheel(wheel, task, form, 20.0, kIso);
    EXPECT_EQ(feature.characteristics.at(0).verdict, Verdict::kVoid);
    return feature.characteristics.at(0).reason.english();
  };
  const Influence axis_um = std::exchange(task.uncertainty->axis_um, std::nullopt);
  EXPECT_THAT(reason(record::Form::kRunOut), HasSubstr("axis_um"));
  EXPECT_EQ(
      evaluated_wheel(wheel, task, record::Form::kRadius, 20.0, kIso).characteristics[0].verdict,
      Verdict::kConforms);
  task.uncertainty->axis_um = axis_um;
  task.uncertainty->point_um.reset();
  EXPECT_THAT(reason(record::Form::kRadius), HasSubstr("point_um"));
  task.uncertainty.reset();
  EXPECT_THAT(reason(record::Form::kRunOut), HasSubstr("no influence"));
  EXPECT_EQ(
      evaluated_wheel(wheel, task, record::Form::kRunOut, 20.0, kSimple).characteristics[0].verdict,
      Verdict::kConforms);
}

// Between few points more than a tenth of the tolerance may be missing.
TEST(WheelInterval, LossBetweenPointsMakesABound) {
  const auto wheel = test::specified_wheel(1, test::even_degrees(8, 0.0, 45.0));
  const WheelTask task = task_of(wheel);
  for (const std::string_view rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    const auto narrow = evaluated_wheel(wheel, task, record::Form::kRunOut, 16.0, rule);
    EXPECT_EQ(narrow.characteristics[0].verdict, Verdict::kVoid);
    EXPECT_THAT(narrow.characteristics[0].reason.english(), HasSubstr("a lower bound"));
    EXPECT_EQ(wheel_gate(narrow, "loss-between-points")->outcome, Gate::Outcome::kBounds);
    // A path does not rest on the effective radius of a bound.
    const auto& m = std::get<WheelResult>(narrow.analysis->found).evaluation.wheel;
    EXPECT_FALSE(m.effective_radius_mm());
  }
  const auto whole = test::specified_wheel(1, kAllRound);
  for (const std::string_view rule : {kSimple, kIso}) {
    SCOPED_TRACE(rule);
    const auto conforms = evaluated_wheel(whole, task_of(whole), record::Form::kRunOut, 15.0, rule);
    EXPECT_EQ(conforms.characteristics[0].verdict, Verdict::kConforms);
  }
}

// A lobe of order 5 with its zeros at ten points reads no roundness, whatever its amplitude; nor
// does a declared noise above a lobe take it out of the loss.
TEST(WheelInterval, LobesThatThePointsDoNotHoldLeaveNoNumber) {
  const auto lobed = [](int points, int order, double amplitude_mm) {
    test::Points2 out;
    for (int i = 0; i < points; ++i) {
      const double angle = 360.0 * core::kDegree * i / points;
      const double radius_mm =
          50.0 + amplitude_mm * std::sin(order * angle) + 0.2e-3 * std::cos(2.0 * angle);
      out.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
    }
    return out;
  };
  WheelTask task;
  task.nominal_radius_mm = 50.0;
  for (const double tolerance_um : {2.0, 10.0, 1000.0}) {
    SCOPED_TRACE(tolerance_um);
    const auto feature = evaluated_wheel(
        run_of(lobed(10, 5, 5e-3), task, {asked(record::Form::kRoundness, tolerance_um)}, kSimple));
    EXPECT_EQ(feature.characteristics.at(0).verdict, Verdict::kVoid);
    EXPECT_THAT(feature.characteristics.at(0).reason.english(), HasSubstr("up to order 4 only"));
    EXPECT_EQ(wheel_gate(feature, "loss-between-points")->outcome, Gate::Outcome::kBounds);
  }
  const auto loss_um = [&](double point_um) {
    task.uncertainty.emplace().point_um = DeclaredInfluence{point_um};
    const auto feature = evaluated_wheel(
        run_of(lobed(16, 3, 0.8e-3), task, {asked(record::Form::kRoundness, 50.0)}, kSimple));
    return wheel_gate(feature, "loss-between-points")->found.value();
  };
  EXPECT_NEAR(loss_um(0.1), loss_um(2.0), 1e-9);
  EXPECT_NEAR(
      loss_um(2.0),
      1.6 * (1.0 - std::cos(33.75 * core::kDegree)) + 0.4 * (1.0 - std::cos(22.5 * core::kDegree)),
      0.01);
}

// Four pairs of points at the zeros of an oval of 5 um read no roundness; the gap is below 90 deg.
TEST(WheelInterval, FourClustersHoldNoOval) {
  test::Points2 points_mm;
  for (const double degrees : {0.0, 0.5, 90.0, 90.5, 180.0, 180.5, 270.0, 270.5}) {
    const double angle = degrees * core::kDegree;
    const double radius_mm = 50.0 + 5e-3 * std::sin(2.0 * angle);
    points_mm.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
  }
  WheelTask task;
  task.nominal_radius_mm = 50.0;
  const auto feature =
      evaluated_wheel(run_of(points_mm, task, {asked(record::Form::kRoundness, 2.0)}, kSimple));
  EXPECT_EQ(feature.characteristics.at(0).verdict, Verdict::kVoid);
  EXPECT_THAT(feature.characteristics.at(0).reason.english(), HasSubstr("up to order 1 only"));
}

TEST(WheelInterval, APathForABoundOfTheEffectiveRadiusIsRefused) {
  const auto few = test::specified_wheel(1, test::even_degrees(8, 0.0, 45.0));
  const auto many = test::specified_wheel(1, kAllRound);
  WheelTask task = task_of(many);
  task.surface.emplace();
  task.surface->coefficients = {0.0, 0.0, 0.5 / 80.0};
  task.surface->from_mm = -20.0;
  task.surface->to_mm = 20.0;
  task.surface->step_mm = 1.0;
  task.surface->radius = record::GroundSurfaceTask::Radius::kEffective;
  const auto path = [&](const test::SpecifiedWheel& wheel) {
    return evaluated_wheel(wheel, task, record::Form::kRunOut, 60.0, kSimple);
  };
  const auto narrow = path(few);
  const auto& refused = std::get<WheelResult>(narrow.analysis->found).evaluation;
  EXPECT_FALSE(refused.path);
  ASSERT_TRUE(refused.refused);
  EXPECT_THAT(refused.refused->what, HasSubstr("lower bound"));
  EXPECT_EQ(wheel_gate(narrow, "path-radius")->outcome, Gate::Outcome::kVoids);
  const auto wide = path(many);
  EXPECT_TRUE(std::get<WheelResult>(wide.analysis->found).evaluation.path);
  EXPECT_EQ(wheel_gate(wide, "path-radius")->outcome, Gate::Outcome::kPassed);
}

// Wear on an arc moves the radius by far more than its noise.
TEST(WheelInterval, FormOnAnArcIsInTheIntervalOfTheRadiusOrVoidsIt) {
  auto wheel = test::specified_wheel(4, test::even_degrees(25, 0.0, 5.0));
  for (std::size_t i = 8; i < 14; ++i) {
    const Eigen::Vector2d outward = (wheel.points_mm[i] - wheel.true_axis_mm).normalized();
    wheel.points_mm[i] -= 4e-3 * outward;
  }
  const WheelTask task = task_of(wheel);
  const auto wide = evaluated_wheel(wheel, task, record::Form::kRadius, 100.0, kIso);
  const auto& m = std::get<WheelResult>(wide.analysis->found).evaluation.wheel;
  ASSERT_GT(m.correlation, fit::kCorrelationLimit);
  const double form_mm = m.form_in_radius_mm();
  EXPECT_GT(form_mm, 4.0 * m.radius_uncertainty_mm);
  const UncertaintyStatement& said = statement(wide.characteristics[0]);
  EXPECT_GT(said.high_mm, 0.95 * form_mm);
  EXPECT_TRUE(std::ranges::is_sorted(said.values_mm));
  EXPECT_EQ(wheel_gate(wide, "form-on-an-arc")->outcome, Gate::Outcome::kWarns);
  for (const std::string_view rule : {kSimple, kIso}) {
    const auto narrow = evaluated_wheel(wheel, task, record::Form::kRadius, 3.9e3 * form_mm, rule);
    EXPECT_EQ(narrow.characteristics[0].verdict, Verdict::kVoid);
    EXPECT_THAT(narrow.characteristics[0].reason.english(), HasSubstr("a quarter"));
    EXPECT_EQ(wheel_gate(narrow, "form-on-an-arc")->outcome, Gate::Outcome::kVoids);
    // Of two limits half their distance counts, wherever they lie.
    record::Characteristic with_sign = asked(record::Form::kRadius, 6.9e3 * form_mm);
    with_sign.lower_mm = -0.9 * form_mm;
    const auto between = evaluated_wheel(run_of(wheel.points_mm, task, {with_sign}, rule));
    EXPECT_EQ(between.characteristics[0].verdict, Verdict::kVoid);
    EXPECT_THAT(between.characteristics[0].reason.english(), HasSubstr("a quarter"));
    EXPECT_EQ(wheel_gate(between, "form-on-an-arc")->outcome, Gate::Outcome::kVoids);
  }
}

// An arc does not tell lobes of two and three from the radius: noise of the points alone held 41,
// 35 and 68 % of the true radii. The arcs lie anywhere on wheels of random phases.
TEST(WheelInterval, TheRadiusOfAnArcHoldsTheTruthWithItsLobes) {
  const int wheels = test::cases(60, 200);
  UncertaintyOptions options;
  options.least_trials = 400;
  record::Characteristic radius = asked(record::Form::kRadius, 100.0);
  radius.lower_mm = -0.1;
  for (const double arc_deg : {120.0, 140.0, 220.0, 285.0}) {
    SCOPED_TRACE(arc_deg);
    int held = 0;
    for (int seed = 0; seed < wheels; ++seed) {
      const auto [points_mm, true_mm] =
          lobed_arc(static_cast<std::uint64_t>(seed), arc_deg, 0.4e-3);
      WheelResult result;
      result.points_mm = points_mm;
      result.task.wheel.nominal_radius_mm = 50.0;
      result.task.wheel.errors = fit::WheelPointErrors{.point_mm = 0.4e-3};
      result.declared.emplace().point_um = DeclaredInfluence{0.4};
      auto found = fit::evaluate_wheel(result.points_mm, result.task);
      ASSERT_TRUE(found) << found.error().what;
      result.evaluation = *std::move(found);
      options.seed = static_cast<std::uint64_t>(seed);
      const auto intervals = intervals_of(result, std::span(&radius, 1), options);
      const auto* said = intervals.at(0).about(Measurand::kSampledPoints);
      ASSERT_NE(said, nullptr) << intervals.at(0).why();
      const double departure_mm = true_mm - 50.0;
      if (said->low_mm <= departure_mm && departure_mm <= said->high_mm) ++held;
    }
    std::printf("%3.0f deg: %d of %d intervals hold R\n", arc_deg, held, wheels);
    EXPECT_GE(held, 0.95 * wheels - 3.3 * std::sqrt(0.95 * 0.05 * wheels));
    if (wheels >= 200) {
      EXPECT_LT(held, wheels);
    }
  }
}

// An oval of 4.1 um and six lobes of 1.1 um at 24 points: the whole turn has 10.4 um.
TEST(WheelInterval, WhatMayBeLostBetweenThePointsIsKeptFromTheLimit) {
  test::Points2 points_mm;
  for (int i = 0; i < 24; ++i) {
    const double angle = core::kTwoPi * i / 24.0;
    const double radius_mm = 50.0 + 4.1e-3 * std::cos(2.0 * angle) + 1.1e-3 * std::cos(6.0 * angle);
    points_mm.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
  }
  const auto judged = [&](std::string_view rule, double tolerance_um) {
    WheelTask task;
    task.nominal_radius_mm = 50.0;
    task.uncertainty.emplace().point_um = DeclaredInfluence{0.02};
    return evaluated_wheel(
        run_of(points_mm, task, {asked(record::Form::kRoundness, tolerance_um)}, rule));
  };
  const auto feature = judged(kIso, 20.0);
  const double value_um = *feature.characteristics.at(0).value_mm() / core::kMicrometre;
  const double loss_um = *wheel_gate(feature, "loss-between-points")->found;
  ASSERT_GT(loss_um, 0.1);
  for (const std::string_view rule : {kIso, kSimple}) {
    SCOPED_TRACE(rule);
    const double limit_um = value_um + 0.7 * loss_um;
    ASSERT_LT(loss_um, 0.1 * limit_um);  // the gate itself passes
    const auto near = judged(rule, limit_um);
    EXPECT_EQ(near.characteristics.at(0).verdict, Verdict::kUndecided);
    EXPECT_THAT(near.characteristics.at(0).reason.english(), HasSubstr("were not seen"));
    EXPECT_EQ(judged(rule, 20.0).characteristics.at(0).verdict, Verdict::kConforms);
  }
}

// More points have more orders, each with its share of the noise: of ten wheels of 24 points none
// had a verdict.
TEST(WheelInterval, NoiseIsNoLossBetweenPoints) {
  const int wheels = test::cases(8, 20);
  for (const std::size_t n : {16, 24, 36}) {
    SCOPED_TRACE(n);
    int conform = 0;
    for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(wheels); ++seed) {
      auto wheel =
          test::specified_wheel(seed, test::even_degrees(n, 0.0, 360.0 / static_cast<double>(n)));
      core::KeyedNoise noise(seed, {24});
      for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector2d outward = (wheel.true_points_mm[i] - wheel.true_axis_mm).normalized();
        wheel.points_mm[i] = wheel.true_points_mm[i] + 1e-3 * noise.normal() * outward;
      }
      WheelTask task = task_of(wheel);
      task.uncertainty->point_um = DeclaredInfluence{1.0};
      const auto feature = evaluated_wheel(wheel, task, record::Form::kRunOut, 20.0, kIso);
      conform += feature.characteristics.at(0).verdict == Verdict::kConforms ? 1 : 0;
      // The least that any noise leaves: eccentricity 5 um and the lobes hold most of it.
      EXPECT_GT(wheel_gate(feature, "loss-between-points")->found.value(), 0.02);
    }
    std::printf("%zu points: %d of %d conform\n", n, conform, wheels);
    EXPECT_GE(20 * conform, 17 * wheels);
  }
}

// Slow form all round is no arc: a correlation above its limit beside "passed" would contradict it.
TEST(WheelInterval, FormOnAnArcIsNoGateOfTheWholeTurn) {
  test::Points2 points_mm;
  for (int i = 0; i < 64; ++i) {
    const double angle = core::kTwoPi * i / 64.0;
    const double radius_mm = 50.0 + 2e-3 * std::cos(2.0 * angle);
    points_mm.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
  }
  WheelTask task;
  task.nominal_radius_mm = 50.0;
  const auto feature =
      evaluated_wheel(run_of(points_mm, task, {asked(record::Form::kRadius, 30.0)}, kSimple));
  const auto& m = std::get<WheelResult>(feature.analysis->found).evaluation.wheel;
  EXPECT_GT(m.correlation, fit::kCorrelationLimit);
  EXPECT_TRUE(std::ranges::none_of(feature.gates,
                                   [](const Gate& gate) { return gate.code == "form-on-an-arc"; }));
}

/// Counts how often the intervals of run-out and roundness hold the truth at the points.
TEST(WheelInterval, HoldsTheTruthAtThePointsAsOftenAsSpecified) {
  constexpr int kWheels = 200;
  UncertaintyOptions options;
  options.least_trials = 400;
  record::Characteristic runout = asked(record::Form::kRunOut, 20.0);
  record::Characteristic round = asked(record::Form::kRoundness, 20.0);
  round.reference = record::Reference::kLeastSquares;
  const std::vector<record::Characteristic> both = {runout, round};
  int held[2] = {0, 0};
  double shift_um = 0.0;
  for (int seed = 100; seed < 100 + kWheels; ++seed) {
    SCOPED_TRACE(seed);
    const auto wheel = test::specified_wheel(static_cast<std::uint64_t>(seed), kAllRound);
    WheelResult result;
    result.points_mm = wheel.points_mm;
    result.task.wheel.axis_mm = wheel.axis_mm;
    result.task.wheel.nominal_radius_mm = 50.0;
    result.declared = task_of(wheel).uncertainty;
    auto found = fit::evaluate_wheel(result.points_mm, result.task);
    ASSERT_TRUE(found) << found.error().what;
    result.evaluation = *std::move(found);
    fit::WheelOptions true_options;
    true_options.axis_mm = wheel.true_axis_mm;
    const auto truth = fit::measure_wheel(wheel.true_points_mm, true_options);
    ASSERT_TRUE(truth) << truth.error().what;
    options.seed = static_cast<std::uint64_t>(seed);
    const auto intervals = intervals_of(result, both, options);
    if (seed == 100) {
      UncertaintyOptions few = options;
      few.least_trials = 99;
      EXPECT_THAT(intervals_of(result, both, few)[1].why().english(), HasSubstr("99"));
    }
    const double true_mm[2] = {truth->runout->fim_mm, truth->check.deviation_mm};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto* said = intervals.at(i).about(Measurand::kSampledPoints);
      ASSERT_NE(said, nullptr) << intervals.at(i).why();
      if (said->low_mm <= true_mm[i] && true_mm[i] <= said->high_mm) ++held[i];
      if (i == 0) shift_um += (said->estimate_mm - true_mm[i]) * 1e3 / kWheels;
    }
  }
  // 94.4 and 94.3 % of 1000 in the specification; 200 scatter by 1.6 %, and 3.3 of that is 5.4 %.
  for (const int count : held) {
    EXPECT_GE(count, 178);
    EXPECT_LE(count, 199);
  }
  EXPECT_NEAR(shift_um, 0.0, 0.3);
}

}  // namespace
}  // namespace rondure::evaluation
