// The interval of an analysis that is foretold before its first reading is that of runs with other
// seeds.

#include "evaluation/prediction/predict.h"

#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/analysis_result.h"
#include "evaluation/evaluate.h"
#include "plans/forecast/forecast.h"
#include "random_inspection.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using evaluation::AnalysisPrediction;
using ::testing::HasSubstr;

Plan plan_of_a_clean_wheel() { return testing::plan_of("06_wheel.json"); }

/// The record of a plan before its run, with series of a seed.
record::RunRecord foretold_record(const Plan& plan, std::uint64_t seed) {
  const auto steps = forecast(plan);
  EXPECT_TRUE(steps) << (steps ? "" : steps.error().what);
  if (!steps) return {};
  auto record = with_series(expected_record(plan, *steps), plan, seed);
  EXPECT_TRUE(record) << (record ? "" : record.error().what);
  return std::move(record).value_or(record::RunRecord());
}

std::vector<AnalysisPrediction> series_foretold(const Plan& plan) {
  const auto out = evaluation::predict_analysis(foretold_record(plan, forecast_seed(plan)), 0);
  EXPECT_TRUE(out) << (out ? "" : out.error().what);
  return out.value_or(std::vector<AnalysisPrediction>());
}

TEST(AnalysisPrediction, IsWhatARunWithItsSeedStates) {
  Plan plan = plan_of_a_clean_wheel();
  ASSERT_NE(forecast_seed(plan), plan.simulation->seed);
  const auto here = foretold_record(plan, forecast_seed(plan));
  const auto own = foretold_record(plan, plan.simulation->seed);
  ASSERT_NE(here.data_of(0, "data"), nullptr);
  EXPECT_NE(here.data_of(0, "data")->values, own.data_of(0, "data")->values);
  plan.simulation->seed = forecast_seed(plan);
  const auto run = test::inspect(plan);
  ASSERT_NE(run.record.data_of(0, "data"), nullptr);
  EXPECT_EQ(here.data_of(0, "data")->values, run.record.data_of(0, "data")->values);
  const auto said = evaluation::predict_analysis(here, 0);
  ASSERT_TRUE(said);
  ASSERT_EQ(run.evaluation.features.size(), 1U);
  for (std::size_t c = 0; c < said->size(); ++c) {
    SCOPED_TRACE(c);
    const auto& value = run.evaluation.features[0].characteristics.at(c).value;
    ASSERT_TRUE(value && value->statement() != nullptr);
    EXPECT_EQ((*said)[c].as_read_mm, value->value_mm());
    EXPECT_EQ((*said)[c].expected_mm, value->statement()->estimate_mm);
    EXPECT_NEAR((*said)[c].expanded_mm(), value->statement()->expanded_mm(), 1e-12);
  }
}

TEST(AnalysisPrediction, ForetellsTheIntervalOfRunsWithOtherSeeds) {
  Plan plan = plan_of_a_clean_wheel();
  const auto said = series_foretold(plan);
  ASSERT_EQ(said.size(), 3U);
  for (std::uint64_t seed = 101; seed <= 104; ++seed) {
    SCOPED_TRACE(seed);
    plan.simulation->seed = seed;
    const auto run = test::inspect(plan);
    ASSERT_EQ(run.evaluation.features.size(), 1U);
    for (std::size_t c = 0; c < said.size(); ++c) {
      SCOPED_TRACE(run.evaluation.features[0].characteristics[c].characteristic.id);
      ASSERT_EQ(said[c].why, "");
      const auto& value = run.evaluation.features[0].characteristics[c].value;
      ASSERT_TRUE(value && value->statement() != nullptr);
      // Seeds scatter by some 5 % (one standard deviation).
      EXPECT_NEAR(said[c].expanded_mm() / value->statement()->expanded_mm(), 1.0, 0.25);
      EXPECT_NEAR(said[c].linear_u_mm / value->statement()->standard_uncertainty_mm, 1.0, 0.25);
      EXPECT_GT(said[c].below_mm, 0.0);
      EXPECT_GT(said[c].above_mm, 0.0);
    }
  }
}

TEST(AnalysisPrediction, GrowsWithWhatIsDeclared) {
  Plan plan = plan_of_a_clean_wheel();
  double last_mm = 0.0;
  double last_linear_mm = 0.0;
  for (const double point_um : {0.2, 0.4, 0.8}) {
    plan.features[0].wheel->uncertainty->point_um = record::DeclaredInfluence{point_um};
    const auto said = series_foretold(plan);
    ASSERT_EQ(said.size(), 3U);
    EXPECT_GT(said[0].expanded_mm(), last_mm);
    EXPECT_GT(said[0].linear_u_mm, last_linear_mm);
    last_mm = said[0].expanded_mm();
    last_linear_mm = said[0].linear_u_mm;
  }
}

TEST(AnalysisPrediction, SaysWhyThereIsNone) {
  Plan plan = plan_of_a_clean_wheel();
  plan.features[0].wheel->uncertainty.reset();
  for (const AnalysisPrediction& said : series_foretold(plan)) {
    EXPECT_THAT(said.why, HasSubstr("declares no influences"));
  }
  for (const AnalysisPrediction& said :
       series_foretold(testing::plan_of("05_spindle_three_probe.json"))) {
    EXPECT_THAT(said.why, ::testing::AnyOf(HasSubstr("gain_1"), HasSubstr("from turn to turn")));
  }
  EXPECT_TRUE(evaluation::why_not_foretold(record::Form::kMotionAsynchronous));
  EXPECT_TRUE(evaluation::why_not_foretold(record::Form::kContourSpread));
  EXPECT_TRUE(evaluation::why_not_foretold(record::Form::kAxisError));
  EXPECT_FALSE(evaluation::why_not_foretold(record::Form::kMotionSynchronous));
}

/// The balls of the combined poses of a calibration, touched where the forecast says.
std::vector<evaluation::BallTouches> touches_of_balls(const Plan& plan) {
  std::vector<evaluation::BallTouches> out;
  const auto steps = forecast(plan);
  EXPECT_TRUE(steps);
  if (!steps) return out;
  const auto points = static_cast<std::size_t>(plan.features[0].rotary_axes->points);
  for (const ForecastStage& stage : steps->stages) {
    if (stage.feature != 0 || stage.pose.alpha_rad == 0.0 || stage.pose.beta_rad == 0.0) continue;
    for (std::size_t i = 0; i + points <= stage.contacts_W.size(); i += points) {
      const auto first = stage.contacts_W.begin() + static_cast<std::ptrdiff_t>(i);
      out.emplace_back(first, first + static_cast<std::ptrdiff_t>(points));
    }
  }
  return out;
}

TEST(ResidualPrediction, IsTheBudgetOfACalibrationThatFollows) {
  Plan plan = testing::plan_of("03_calibrate_fixture.json");
  auto& said = plan.features[0].rotary_axes->uncertainty.emplace();
  said.ball_um = record::DeclaredInfluence{0.1};
  said.repeat_urad = said.reading_urad = record::DeclaredInfluence{1.0};
  plan.uncertainty.emplace().probe.emplace().repeatability_um =
      plan.simulation->probe.repeatability_um;
  const auto balls = touches_of_balls(plan);
  const auto told = evaluation::predict_residual(foretold_record(plan, 1), 0, balls);
  ASSERT_TRUE(told) << told.error().what;
  ASSERT_EQ(told->why, "");
  auto run = test::inspect(plan);
  run.record.header.started_utc = "2026-11-01T08:00:00Z";  // a calibration has a date
  const auto evaluated = evaluation::evaluate(run.record);
  ASSERT_TRUE(evaluated) << evaluated.error().what;
  ASSERT_EQ(evaluated->features.size(), 1U);
  const auto& found = evaluated->features[0];
  ASSERT_TRUE(found.analysis) << (found.failure ? found.failure->what : "");
  const auto& facts = std::get<evaluation::RotaryResult>(found.analysis->found);
  std::size_t centers = 0;
  for (const auto& pose : facts.combined) centers += pose.points;
  EXPECT_EQ(told->centers, centers);
  // The run takes the scatter of its own touches, known to some 3 %.
  EXPECT_NEAR(told->center_u_mm / facts.center_u_mm, 1.0, 0.12);
  for (const auto& characteristic : found.characteristics) {
    ASSERT_TRUE(characteristic.value && characteristic.value->uncertainty().result());
    const auto& budget = characteristic.value->uncertainty().result()->budget;
    ASSERT_EQ(budget.size(), 1U);
    const double u_mm = budget[0].standard_uncertainty_mm;
    if (characteristic.characteristic.form == record::Form::kFixtureResidualRms) {
      EXPECT_NEAR(told->rms_u_mm * facts.noise_mm / told->center_u_mm, u_mm, 1e-9);
    } else {
      EXPECT_LE(u_mm, facts.noise_mm * (1.0 + 1e-9));
      EXPECT_EQ(told->largest_u_mm, told->center_u_mm);
    }
  }
}

TEST(ResidualPrediction, SaysWhyThereIsNone) {
  Plan plan = testing::plan_of("03_calibrate_fixture.json");
  const auto balls = touches_of_balls(plan);
  const auto undeclared = evaluation::predict_residual(foretold_record(plan, 1), 0, balls);
  ASSERT_TRUE(undeclared);
  EXPECT_THAT(undeclared->why, HasSubstr("no influence is declared"));
  plan.features[0].rotary_axes->uncertainty.emplace().ball_um = record::DeclaredInfluence{0.1};
  const auto record = foretold_record(plan, 1);
  const auto no_pose = evaluation::predict_residual(record, 0, {});
  ASSERT_TRUE(no_pose);
  EXPECT_THAT(no_pose->why, HasSubstr("no combined pose"));
  const auto assumed = evaluation::predict_residual(record, 0, balls);
  ASSERT_TRUE(assumed);
  EXPECT_THAT(assumed->repeatability, HasSubstr("the most that the qualification lets pass"));
  EXPECT_FALSE(evaluation::predict_residual(record, 1, balls));
}

TEST(AnalysisPrediction, RefusesAFeatureThatIsNoAnalysisOfSeries) {
  const Plan plan = testing::plan_of("01_spool_simulated.json");
  const auto record = foretold_record(plan, forecast_seed(plan));
  for (const int feature : {-1, 0, 1}) {
    const auto said = evaluation::predict_analysis(record, feature);
    ASSERT_FALSE(said) << feature;
    EXPECT_EQ(said.error().code, core::Code::kBadOption);
  }
}

}  // namespace
}  // namespace rondure::plans
