// A probe that is qualified on a column: what its touches give, what they cannot vouch for, and
// what a plan with one must say.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "evaluation/evaluate.h"
#include "plans/forecast/forecast.h"
#include "plans/run/internal/qualification.h"
#include "plans/run/runner.h"
#include "reports/html/report.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines_of;

/// The first example on a column, changed by a merge patch.
PlanOrProblems on_column(const Json& patch = Json::object()) {
  Json out = Json::parse(testing::bytes_of(testing::example("01_spool_simulated.json")));
  out["probe"]["qualification"] = {{"artefact", "column"},
                                   {"column_diameter_mm", 25.0008},
                                   {"column_point_mm", {300, 0, 100}},
                                   {"column_from_mm", -15},
                                   {"column_to_mm", 15},
                                   {"form_limit_um", 5}};
  out.merge_patch(patch);
  return parse_plan(out.dump(), {}, "plan.json");
}

testing::Ran run_on_column(const Json& patch) { return testing::ran(on_column(patch)); }

Json leaning(double deg) {
  return {{"simulation", {{"probe", {{"column_lean_deg", deg}, {"tip_radius_error_um", -1.5}}}}}};
}

TEST(Column, GivesTheRadiusOfTheTipWhateverItsLean) {
  for (const double lean_deg : {0.0, 1.5}) {
    SCOPED_TRACE(lean_deg);
    const testing::Ran run = run_on_column(leaning(lean_deg));
    ASSERT_FALSE(run.failure) << run.failure->what;
    const auto found = evaluation::evaluate(run.record).value();
    ASSERT_TRUE(found.probe);
    EXPECT_NEAR(found.probe->radius_mm, 1.9985, 4.0 * found.probe->radius_sigma_mm);
    EXPECT_LT(found.probe->radius_sigma_mm, 2e-4);
    EXPECT_NEAR(std::acos(found.probe->column_axis.z()) * 180.0 / M_PI, lean_deg, 0.01);
    EXPECT_EQ(found.verdict, evaluation::Verdict::kConforms);
    const std::string page = reports::write_html(run.record, found);
    EXPECT_THAT(page, HasSubstr("Reference column"));
    EXPECT_THAT(page, HasSubstr("° from upright"));
  }
  const testing::Ran run = run_on_column(leaning(2.5));
  ASSERT_TRUE(run.failure);
  EXPECT_THAT(core::to_line(*run.failure),
              AllOf(HasSubstr("calibration"), HasSubstr("leans 2.50 deg, the limit is 2 deg")));
}

TEST(Column, IsGoneAroundWithoutATouchOnTheWay) {
  for (const int points : {6, 8, 13}) {
    const auto plan = on_column(
        {{"probe", {{"qualification", {{"points_per_height", points}, {"heights", 2}}}}}});
    ASSERT_TRUE(plan) << lines_of(plan);
    const auto steps = qualification_steps(*plan);
    ASSERT_TRUE(steps) << steps.error().what;
    ASSERT_EQ(steps->size(), 2U * static_cast<std::size_t>(points));
    const double apart_mm = 12.5004 + 2.0 + plan->machine->approach_mm;
    Eigen::Vector3d at = steps->front().way_W.front();
    for (const TouchStep& step : *steps) {
      EXPECT_LT((step.way_W.front() - at).norm(), 1e-12) << "a way begins where the last one ended";
      for (std::size_t i = 1; i < step.way_W.size(); ++i) {
        for (double t = 0.0; t <= 1.0; t += 0.01) {
          const Eigen::Vector3d p = step.way_W[i - 1] + t * (step.way_W[i] - step.way_W[i - 1]);
          EXPECT_GT(std::hypot(p.x() - 300.0, p.y()), apart_mm - 1e-9);
        }
      }
      at = step.way_W.back();
      EXPECT_LT((step.entry_W.back() - at).norm(), 1e-12);
    }
  }
}

TEST(Column, VouchesForApproachesFromItsSideAlone) {
  const Json tilted = {
      {"features",
       Json::array({{{"id", "running surface"},
                     {"type", "cylinder"},
                     {"nominal", {{"diameter_mm", 50}, {"from_mm", -40}, {"to_mm", 40}}},
                     {"pose_search", {{"strategy", "start-pose"}}},
                     {"characteristics", Json::array({{{"id", "CYLt"},
                                                       {"form", "cylindricity"},
                                                       {"reference", "mz"},
                                                       {"tolerance_um", 30}}})}}})}};
  const auto verdict = [&](double slope_deg) {
    Json patch = tilted;
    patch["probe"]["qualification"]["column_slope_deg"] = slope_deg;
    patch["decision_rule"]["rule"] = "simple-acceptance";
    patch["uncertainty"] = nullptr;
    const testing::Ran run = run_on_column(patch);
    EXPECT_FALSE(run.failure) << run.failure->what;
    const auto judged = [](const record::RunRecord& record) {
      return evaluation::evaluate(record).value().features.at(0).characteristics.at(0);
    };
    record::RunRecord renumbered = run.record;  // a pose is known by its number, not its place
    for (record::PoseVisit& pose : renumbered.poses) pose.id += 5;
    for (record::Touch& touch : renumbered.touches) touch.pose += touch.pose >= 0 ? 5 : 0;
    EXPECT_EQ(judged(renumbered).verdict, judged(run.record).verdict);
    return judged(run.record);
  };
  // The spool leans 2.3 deg in its ring, so do the approaches.
  EXPECT_EQ(verdict(2.5).verdict, evaluation::Verdict::kConforms);
  const auto beyond = verdict(2.0);
  EXPECT_EQ(beyond.verdict, evaluation::Verdict::kVoid);
  EXPECT_THAT(beyond.reason.english(), HasSubstr("qualified on a column"));
}

TEST(Column, IsForetoldAndKeptClearOf) {
  const auto plan = on_column();
  ASSERT_TRUE(plan) << lines_of(plan);
  const auto found = forecast(*plan);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_EQ(found->stages.front().touches, 24);
  EXPECT_THAT(
      lines_of(on_column({{"probe", {{"qualification", {{"column_point_mm", {60, 0, 100}}}}}}})),
      AllOf(HasSubstr("/probe/qualification/column_point_mm: "),
            HasSubstr("the reference column stands")));
  EXPECT_THAT(lines_of(on_column({{"probe", {{"qualification", {{"column_to_mm", 420}}}}}})),
              HasSubstr("/machine/park_mm"));
}

TEST(Column, NeedsItsKeysAndNoTouchesFromAbove) {
  const auto problems = [](const Json& patch) {
    return lines_of(on_column({{"probe", {{"qualification", patch}}}}));
  };
  EXPECT_THAT(problems({{"column_diameter_mm", nullptr}}),
              HasSubstr("/probe/qualification/column_diameter_mm: this key is missing"));
  EXPECT_THAT(problems({{"sphere_diameter_mm", 25}}),
              HasSubstr("has no effect: the artefact is a column"));
  EXPECT_THAT(problems({{"artefact", "sphere"}}),
              HasSubstr("has no effect: the artefact is a sphere"));
  EXPECT_THAT(problems({{"column_to_mm", -20}}), HasSubstr("is not above the lower one"));
  EXPECT_THAT(problems({{"heights", 1}}), HasSubstr("/probe/qualification/heights"));
  EXPECT_THAT(
      lines_of(on_column(
          {{"probe",
            {{"stylus_length_mm", 25}, {"stylus_diameter_mm", 2}, {"holder_diameter_mm", 20}}}})),
      HasSubstr("the holder of the stylus leaves 20 mm"));
  EXPECT_THAT(
      lines_of(on_column({{"features", Json::array({{{"id", "face"},
                                                     {"type", "plane"},
                                                     {"nominal",
                                                      {{"z_mm", 0},
                                                       {"faces", "up"},
                                                       {"from_diameter_mm", 10},
                                                       {"to_diameter_mm", 60}}},
                                                     {"characteristics", Json::array()}}})}})),
      AllOf(HasSubstr("/probe/qualification/artefact"),
            HasSubstr("feature \"face\" is touched from above")));
}

}  // namespace
}  // namespace rondure::plans
