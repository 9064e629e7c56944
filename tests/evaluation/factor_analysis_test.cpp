// Why two programs differ, of analyses: the roundness of wheels and of the part on a spindle
// against circles fitted by hand and against waves whose value is known; all else with its reason.
#include "evaluation/factors/study.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "fit/least_squares/circle.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"
#include "tests/evaluation/points_run.h"
#include "tests/evaluation/simulated_analyses.h"

namespace rondure::reports {

using namespace evaluation;
namespace {

using record::Form;
using ::testing::HasSubstr;

constexpr double kSame_um = 1e-4;

RunComparison comparison_of(const record::RunRecord& run) {
  const auto out = compare_run(evaluated(run));
  EXPECT_TRUE(out) << out.error().what;
  return out.value_or(RunComparison{});
}

/// The value of a cell that differs from the report in one factor [um].
double changed_um(const FactorStudy& study, Factor factor, const std::string& level) {
  const auto& names = study.levels[at(factor)];
  const auto found = std::ranges::find(names, level);
  EXPECT_NE(found, names.end()) << level;
  if (found == names.end()) return std::nan("");
  const FactorCell& cell = study.changed(factor, static_cast<std::size_t>(found - names.begin()));
  EXPECT_TRUE(cell.value_mm) << level << ": " << cell.why;
  return cell.value_mm ? core::micrometres(*cell.value_mm) : std::nan("");
}

std::vector<Eigen::Vector2d> edge_of_run(const record::RunRecord& run) {
  const auto& values = run.series.front().values;
  std::vector<Eigen::Vector2d> out;
  for (std::size_t i = 0; i + 1 < values.size(); i += 2) out.emplace_back(values[i], values[i + 1]);
  return out;
}

/// A wheel whose points have no noise.
record::RunRecord quiet_wheel(std::optional<std::size_t> proud_point) {
  SimulatedWheel world = worked_wheel(whole_turn());
  world.point_um = 0.0;
  world.axis_um = 0.0;
  world.proud_point = proud_point;
  world.proud_um = proud_point ? 45.0 : 0.0;
  Normals draws(1);
  record::RunRecord run = wheel_run(world, {}, draws);
  run.features.front().characteristics = {asked(Form::kRoundness), asked(Form::kRunOut),
                                          asked(Form::kRadius)};
  return run;
}

TEST(FactorsOfAnalyses, RoundnessOfAWheelIsThatOfCirclesFittedByHand) {
  const record::RunRecord run = quiet_wheel({});
  const RunComparison comparison = comparison_of(run);
  ASSERT_EQ(comparison.studies.size(), 1U);
  const FactorStudy& study = comparison.studies.front();
  EXPECT_EQ(study.symbol, "RONt");
  const auto points = edge_of_run(run);
  const auto um = [](double length_mm) { return core::micrometres(length_mm); };
  EXPECT_NEAR(changed_um(study, Factor::kReference, "LSCI"),
              true_wheel_roundness_um(worked_wheel(whole_turn())), 2e-3);
  EXPECT_NEAR(changed_um(study, Factor::kReference, "MZCI"),
              um(fit::min_zone_circle(points)->width_mm()), kSame_um);
  EXPECT_NEAR(changed_um(study, Factor::kReference, "MCCI"),
              um(fit::min_circumscribed_circle(points)->deviation_mm), kSame_um);
  EXPECT_NEAR(changed_um(study, Factor::kReference, "MICI"),
              um(fit::max_inscribed_circle(points)->deviation_mm), kSame_um);
  std::vector<Eigen::Vector2d> second;
  for (std::size_t i = 0; i < points.size(); i += 2) second.push_back(points[i]);
  EXPECT_NEAR(changed_um(study, Factor::kSampling, "points 1, 3, 5, ..."),
              um(fit::ls_circle(second)->deviation_mm), kSame_um);
}

TEST(FactorsOfAnalyses, AProudPointOfAWheelIsFoundByTheRuleOfMedians) {
  const record::RunRecord run = quiet_wheel(4);
  const RunComparison comparison = comparison_of(run);
  ASSERT_EQ(comparison.studies.size(), 1U);
  const FactorStudy& study = comparison.studies.front();
  auto points = edge_of_run(run);
  EXPECT_NEAR(core::micrometres(study.reported_mm),
              core::micrometres(fit::ls_circle(points)->deviation_mm), kSame_um);
  points.erase(points.begin() + 4);
  EXPECT_NEAR(changed_um(study, Factor::kOutliers, "5 medians"),
              core::micrometres(fit::ls_circle(points)->deviation_mm), kSame_um);
}

/// Three lobes of 4 um, which every reference circle finds at 8 um, without motion.
record::RunRecord three_lobes(double cutoff_upr) {
  SimulatedSpindle world = worked_spindle(record::SpindleTask::Layout::kReference);
  world.profile = {{3.0, 4.0, -0.8}};
  world.motion_x.clear();
  world.motion_y.clear();
  record::SpindleTask task = spindle_task(record::SpindleTask::Layout::kReference, world);
  task.cutoff_upr = cutoff_upr;
  Normals draws(1);
  record::RunRecord run = spindle_run(world, task, draws);
  run.features.front().characteristics = {asked(Form::kRoundness), asked(Form::kRoundnessRms),
                                          asked(Form::kMotionSynchronous)};
  return run;
}

/// Share of an amplitude that a Gaussian low pass keeps: one half at the cut-off.
double kept_of_three_lobes(double cutoff_upr) {
  return std::pow(0.5, (3.0 / cutoff_upr) * (3.0 / cutoff_upr));
}

TEST(FactorsOfAnalyses, TheProfileOnASpindleIsFilteredAsAnotherProgramWould) {
  constexpr double kSampled_um = 3e-3;  // 512 samples miss the tops of the lobes by 0.7 nm each
  const RunComparison comparison = comparison_of(three_lobes(50.0));
  ASSERT_EQ(comparison.studies.size(), 1U);
  const FactorStudy& study = comparison.studies.front();
  EXPECT_EQ(study.levels[at(Factor::kFilter)][study.reported[at(Factor::kFilter)]],
            "Gaussian 50 UPR");
  EXPECT_NEAR(core::micrometres(study.reported_mm), 8.0 * kept_of_three_lobes(50.0), kSampled_um);
  EXPECT_NEAR(changed_um(study, Factor::kFilter, "unfiltered"), 8.0, kSampled_um);
  EXPECT_NEAR(changed_um(study, Factor::kFilter, "Gaussian 15 UPR"),
              8.0 * kept_of_three_lobes(15.0), kSampled_um);
  for (const char* reference : {"MZCI", "MCCI", "MICI"}) {
    EXPECT_NEAR(changed_um(study, Factor::kReference, reference), 8.0 * kept_of_three_lobes(50.0),
                kSampled_um)
        << reference;
  }
}

TEST(FactorsOfAnalyses, ACutOffOfThePlanIsALevelOfItsOwn) {
  const RunComparison comparison = comparison_of(three_lobes(30.0));
  ASSERT_EQ(comparison.studies.size(), 1U);
  const FactorStudy& study = comparison.studies.front();
  const auto& names = study.levels[at(Factor::kFilter)];
  ASSERT_EQ(names.size(), 5U);
  EXPECT_EQ(names[study.reported[at(Factor::kFilter)]], "Gaussian 30 UPR");
  EXPECT_NEAR(changed_um(study, Factor::kFilter, "Gaussian 50 UPR"),
              8.0 * kept_of_three_lobes(50.0), 3e-3);
}

/// What is said of a characteristic that is not compared.
std::string why_not(const RunComparison& comparison, const std::string& id) {
  for (const core::Error& error : comparison.without) {
    if (error.where.ends_with("/ " + id)) return error.what;
  }
  return "nothing";
}

TEST(FactorsOfAnalyses, WhatHasNoReferenceCircleSaysSoByItsName) {
  const RunComparison wheel = comparison_of(quiet_wheel({}));
  EXPECT_THAT(why_not(wheel, "run-out"), HasSubstr("about the axis of the spindle"));
  EXPECT_THAT(why_not(wheel, "radius"), HasSubstr("a mean distance"));
  const RunComparison spindle = comparison_of(three_lobes(50.0));
  EXPECT_THAT(why_not(spindle, "roundness-rms"), HasSubstr("least-squares circle by definition"));
  EXPECT_THAT(why_not(spindle, "motion-synchronous"), HasSubstr("ISO 230-7"));
}

TEST(FactorsOfAnalyses, AFixtureIsRefusedWithTheReason) {
  Normals draws(1);
  record::RunRecord run = ball_plate_run(20.0, draws);
  run.features.front().characteristics = {asked(Form::kFixtureResidual)};
  const auto refused = compare_run(evaluated(run));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("the places that the calibration predicts"));
}

}  // namespace
}  // namespace rondure::reports
