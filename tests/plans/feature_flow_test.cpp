// A plan in which a feature takes a value of another one: what is refused, and a run of it.

#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/evaluate.h"
#include "plans/run/runner.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSwept = R"({ "id": "axis", "type": "wheel",
    "wheel": { "mode": "envelope", "nominal_radius_mm": 50.0, "uncertainty": { "point_um": 0.4 } },
    "characteristics": [ { "id": "R", "form": "radius", "tolerance_um": 100 } ] })";

/// A wheel at rest that takes its axis of a feature; `more` are further keys.
std::string wheel_at_rest(const std::string& id, const std::string& axis_of,
                          const std::string& more = {}) {
  return fmt::format(R"({{ "id": "{}", "type": "wheel",
    "wheel": {{ "mode": "indexed", "nominal_radius_mm": 50.0, "axis_from": {{ "feature": "{}" }}{},
                "uncertainty": {{ "point_um": 0.4 }} }},
    "characteristics": [ {{ "id": "FIM", "form": "run-out", "tolerance_um": 20 }} ] }})",
                     id, axis_of, more);
}

std::string plan_of_features(const std::string& features) {
  return fmt::format(R"({{ "plan": {{ "name": "wheel about its axis", "revision": "A" }},
  "part": {{ "id": "GW", "name": "wheel" }}, "features": [ {} ],
  "decision_rule": {{ "rule": "iso-14253-1" }},
  "simulation": {{ "seed": 4, "wheel": {{ "radius_mm": 49.9832, "axis_x_mm": 12.004, "axis_z_mm": -7.0,
    "eccentricity_um": 5.0, "eccentricity_deg": 215.0, "noise_um": 0.4, "points": 16,
    "lobes": [ {{ "order": 2, "amplitude_um": 1.2, "phase_deg": 40.0 }} ] }} }} }})",
                     features);
}

std::string problems_of(const std::string& features) {
  return testing::lines_of(parse_plan(plan_of_features(features), {}, "plan.json"));
}

TEST(FeatureReferences, TheAxisOfAnEarlierEnvelopeIsAccepted) {
  EXPECT_EQ(problems_of(std::string(kSwept) + "," + wheel_at_rest("wheel", "axis")), "");
}

TEST(FeatureReferences, AnUnknownFeatureIsRefused) {
  EXPECT_THAT(problems_of(std::string(kSwept) + "," + wheel_at_rest("wheel", "axle")),
              HasSubstr("/features/1/wheel/axis_from/feature: no feature has the id \"axle\""));
}

TEST(FeatureReferences, AFeatureThatGivesNoAxisIsRefused) {
  const std::string two = std::string(kSwept) + "," + wheel_at_rest("first", "axis") + "," +
                          wheel_at_rest("b", "first");
  EXPECT_THAT(
      problems_of(two),
      HasSubstr("/features/2/wheel/axis_from/feature: feature \"first\" is measured indexed"));
  std::string of_quadruples = kSwept;
  const std::string mode = "\"mode\": \"envelope\"";
  of_quadruples.replace(of_quadruples.find(mode), mode.size(), mode + ", \"center\": \"weighted\"");
  EXPECT_THAT(problems_of(of_quadruples + "," + wheel_at_rest("wheel", "axis")),
              HasSubstr("is a mean of quadruples, which has no covariance"));
}

TEST(FeatureReferences, ALaterFeatureItselfAndACircleAreRefused) {
  const std::string later = problems_of(wheel_at_rest("wheel", "axis") + "," + kSwept);
  EXPECT_THAT(later, HasSubstr("feature \"axis\" comes later"));
  EXPECT_THAT(later, Not(HasSubstr("circle")));
  EXPECT_THAT(problems_of(wheel_at_rest("wheel", "wheel")),
              HasSubstr("a feature takes no value of itself"));
  EXPECT_THAT(
      problems_of(wheel_at_rest("a", "b") + "," + wheel_at_rest("b", "a")),
      HasSubstr("/features/0/wheel/axis_from/feature: feature \"b\" itself takes a value that "
                "depends on this one"));
}

TEST(FeatureReferences, AnAxisGivenTwiceIsRefused) {
  const std::string twice =
      wheel_at_rest("wheel", "axis", R"(, "axis_x_mm": 1.0, "axis_z_mm": 2.0)");
  EXPECT_THAT(problems_of(std::string(kSwept) + "," + twice),
              HasSubstr("/features/1/wheel/axis_x_mm: the axis is that of an earlier feature"));
}

TEST(FeatureReferences, ARunKeepsTheReferenceAndIsJudgedAboutTheAxis) {
  const std::string text =
      plan_of_features(std::string(kSwept) + "," + wheel_at_rest("wheel", "axis"));
  const auto plan = parse_plan(text, {}, "plan.json");
  ASSERT_TRUE(plan) << testing::lines_of(plan);
  const record::Scratch scratch;
  const auto run = run_plan(*plan, testing::options_for(scratch / "run"));
  ASSERT_TRUE(run && !run->failure);
  const auto evaluation = evaluation::evaluate(testing::journal_of(scratch / "run"));
  ASSERT_TRUE(evaluation);
  const auto& judged = evaluation->features.at(1).characteristics.at(0);
  EXPECT_EQ(judged.verdict, evaluation::Verdict::kConforms) << judged.reason;
  ASSERT_TRUE(judged.value && judged.value->statement() != nullptr) << judged.reason;
  EXPECT_THAT(evaluation->features.at(1).gates.front().code, HasSubstr("chain-void"));
}

}  // namespace
}  // namespace rondure::plans
