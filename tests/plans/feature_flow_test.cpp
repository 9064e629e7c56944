// A plan in which a feature takes a value of another one: what is refused, and a run of it.

#include <algorithm>
#include <cmath>
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

using ::testing::AllOf;
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

/// A swing arm whose wheel radius is that of a feature; `more` are further keys.
std::string arm_on(const std::string& wheel, const std::string& more = {}) {
  return fmt::format(R"({{ "id": "arm", "type": "spindle",
    "spindle": {{ "layout": "published-a", "crank_radius_mm": 30.0, "pin_radius_mm": 24.56,
                  "wheel_radius_from": {{ "feature": "{}" }}{} }},
    "characteristics": [ {{ "id": "RONt", "form": "roundness", "reference": "ls", "tolerance_um": 20 }} ] }})",
                     wheel, more);
}

/// Pins whose wheel radius is that of a feature; `more` are further keys.
std::string pins_of(const std::string& wheel, const std::string& more = {}) {
  return fmt::format(R"({{ "id": "pins", "type": "contour",
    "contour": {{ "crank_radius_mm": 30.0, "wheel_radius_from": {{ "feature": "{}" }}{} }},
    "characteristics": [ {{ "id": "t", "form": "contour-deviation", "tolerance_um": 20 }} ] }})",
                     wheel, more);
}

/// A plan with simulated arm and pins, both on a wheel that is 0.09 mm smaller than nominal.
std::string ground_plan(const std::string& features) {
  std::string out = plan_of_features(features);
  const std::string radius = "\"radius_mm\": 49.9832";
  out.replace(out.find(radius), radius.size(), "\"radius_mm\": 49.905");
  const std::string seed = "\"seed\": 4,";
  out.replace(out.find(seed), seed.size(), R"("seed": 4,
    "spindle": { "turns": 4, "eccentricity_um": 20.0, "probe_noise_um": 0.005,
      "profile": [ { "order": 3, "amplitude_um": 2.0 } ], "motion_x": [ { "order": 2, "amplitude_um": 1.0 } ] },
    "contour": { "parts": 2, "x_error": [ { "order": 5, "amplitude_um": 2.0 } ] },)");
  return out;
}

std::string problems_on_wheel(const std::string& features) {
  return testing::lines_of(parse_plan(ground_plan(features), {}, "plan.json"));
}

TEST(FeatureReferences, TheRadiusOfAnEarlierEnvelopeIsAccepted) {
  EXPECT_EQ(problems_on_wheel(std::string(kSwept) + "," + arm_on("axis") + "," + pins_of("axis")),
            "");
}

TEST(FeatureReferences, ARadiusThatNoEarlierWheelGivesIsRefused) {
  const std::string arm = "/features/1/spindle/wheel_radius_from/feature: ";
  const std::string pins = "/features/1/contour/wheel_radius_from/feature: ";
  const std::string swept = std::string(kSwept) + ",";
  EXPECT_THAT(problems_on_wheel(swept + arm_on("axle")), HasSubstr(arm + "no feature has the id"));
  EXPECT_THAT(problems_on_wheel(swept + pins_of("axle")),
              HasSubstr(pins + "no feature has the id"));
  EXPECT_THAT(problems_on_wheel(pins_of("arm") + "," + arm_on("axis") + "," + kSwept),
              AllOf(HasSubstr("/features/0/contour/wheel_radius_from/feature: feature \"arm\" "
                              "comes later"),
                    HasSubstr(arm + "feature \"axis\" comes later")));
  EXPECT_THAT(problems_on_wheel(arm_on("pins") + "," + pins_of("arm")),
              HasSubstr("/features/0/spindle/wheel_radius_from/feature: feature \"pins\" itself "
                        "takes a value that depends on this one"));
  EXPECT_THAT(problems_on_wheel(swept + arm_on("axis") + "," + pins_of("arm")),
              HasSubstr("/features/2/contour/wheel_radius_from/feature: feature \"arm\" is a "
                        "spindle"));
  EXPECT_THAT(problems_on_wheel(swept + wheel_at_rest("wheel", "axis") + "," + arm_on("wheel")),
              HasSubstr("feature \"wheel\" is measured indexed"));
  std::string unknown = kSwept;
  const std::string nominal = "\"nominal_radius_mm\": 50.0, ";
  unknown.erase(unknown.find(nominal), nominal.size());
  EXPECT_THAT(problems_on_wheel(unknown + "," + arm_on("axis")),
              HasSubstr(arm + "feature \"axis\" has no nominal_radius_mm"));
}

TEST(FeatureReferences, ARadiusGivenTwiceOrWithoutEffectIsRefused) {
  const std::string number = R"(, "wheel_radius_mm": 50.0)";
  const std::string twice = "the wheel radius is that of an earlier feature";
  EXPECT_THAT(problems_on_wheel(std::string(kSwept) + "," + arm_on("axis", number)),
              HasSubstr("/features/1/spindle/wheel_radius_mm: " + twice));
  EXPECT_THAT(problems_on_wheel(std::string(kSwept) + "," + pins_of("axis", number)),
              HasSubstr("/features/1/contour/wheel_radius_mm: " + twice));
  std::string still = arm_on("axis");
  const std::string crank = "\"crank_radius_mm\": 30.0, ";
  still.erase(still.find(crank), crank.size());
  EXPECT_THAT(problems_on_wheel(std::string(kSwept) + "," + still),
              HasSubstr("/features/1/spindle/wheel_radius_from: has no effect"));
}

// The first harmonic would void an arm on which probes are turned by 0.2 deg without a word.
TEST(FeatureReferences, ASimulatedArmStandsOnTheSimulatedWheel) {
  const auto plan =
      parse_plan(ground_plan(std::string(kSwept) + "," + arm_on("axis") + "," + pins_of("axis")),
                 {}, "plan.json");
  ASSERT_TRUE(plan) << testing::lines_of(plan);
  const record::Scratch scratch;
  const auto run = run_plan(*plan, testing::options_for(scratch / "run"));
  ASSERT_TRUE(run && !run->failure);
  const auto evaluation = evaluation::evaluate(testing::journal_of(scratch / "run"));
  ASSERT_TRUE(evaluation);
  for (const std::size_t feature : {1U, 2U}) {
    const auto& result = evaluation->features.at(feature);
    ASSERT_TRUE(result.analysis) << (result.failure ? result.failure->what : "");
    const auto passed = [](const evaluation::Gate& gate) {
      return gate.outcome != evaluation::Gate::Outcome::kVoids;
    };
    for (const char* const code : {"chain-void", "first-harmonic"}) {
      const auto gate = std::ranges::find(result.gates, code, &evaluation::Gate::code);
      if (gate == result.gates.end()) {
        EXPECT_EQ(feature, 2U) << code;  // pins have no first harmonic
      } else {
        EXPECT_TRUE(passed(*gate)) << gate->reason.english();
      }
    }
  }
  const auto& roundness = evaluation->features.at(1).characteristics.at(0);
  ASSERT_TRUE(roundness.value);
  // 2 um to either side, less what the low pass of 50 UPR takes of 3 UPR.
  EXPECT_NEAR(*roundness.value_mm() * 1e3, 4.0 * std::exp2(-std::pow(3.0 / 50.0, 2)), 0.1);
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
  of_quadruples.replace(of_quadruples.find(mode), mode.size(),
                        mode + ", \"center\": \"as-published\"");
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
