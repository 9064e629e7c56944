// Plans that once gave a wrong or dishonest result; each must come out right.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/evaluate.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A run of the first example with changes, evaluated.
struct HardRun {
  Scratch folder;
  Outcome outcome;

  explicit HardRun(const std::vector<Change>& changes) {
    write_plan(folder / "plan.json", changes);
    outcome = rondure({"run", folder / "plan.json", "--out", folder / "run"});
  }
  [[nodiscard]] json report() const { return json::parse(read(folder / "run" / "report.json")); }
  [[nodiscard]] double value_um() const {
    return report().at("/features/0/characteristics/0/value_um"_json_pointer).get<double>();
  }
  [[nodiscard]] double truth_um() const {
    return report()
        .at("/features/0/characteristics/0/simulation/0/truth_um"_json_pointer)
        .get<double>();
  }
};

/// The first example as one section of a circle.
std::vector<Change> circle(double start_alpha_deg) {
  return {{"/features/0/type", "circle"},
          {"/features/0/sampling", {{"points_per_layer", 9}}},
          {"/features/0/pose_search", {{"start_alpha_deg", start_alpha_deg}, {"repeats", 5}}},
          {"/features/0/characteristics",
           {{{"id", "RONt"}, {"form", "roundness"}, {"reference", "mz"}, {"tolerance_um", 8}}}}};
}

// The part is tilted by 2.3 deg in the ring: read across machine z its section would be an ellipse
// 20 um wide, at 10 deg 380 um.
TEST(HardPlan, ATouchedCircleIsMeasuredAcrossItsOwnAxis) {
  for (const double alpha : {0.0, 10.0}) {
    SCOPED_TRACE(alpha);
    const HardRun run(circle(alpha));
    ASSERT_EQ(run.outcome.status, 0) << run.outcome.err;
    EXPECT_NEAR(run.value_um(), run.truth_um(), 2.0 * 4.0 * 0.3 / std::sqrt(5.0));
    EXPECT_THAT(run.outcome.out, HasSubstr("RONt"));
    EXPECT_THAT(run.outcome.out, ::testing::Not(HasSubstr("CYLt")));
  }
}

TEST(HardPlan, AFarStartPoseDoesNotLeadTheFitAstray) {
  for (const char* strategy : {"virtual", "guided"}) {
    SCOPED_TRACE(strategy);
    const HardRun run({{"/features/0/pose_search",
                        {{"strategy", strategy}, {"start_alpha_deg", 40}, {"repeats", 5}}},
                       {"/fixture/rim_height_mm", -500}});
    ASSERT_EQ(run.outcome.status, 0) << run.outcome.err;
    EXPECT_NEAR(run.value_um(), run.truth_um(), 2.0 * 4.0 * 0.3 / std::sqrt(5.0));
    EXPECT_LT(run.truth_um(), 12.0);
  }
}

TEST(HardPlan, APerfectPartConformsAndVerifies) {
  const HardRun run(
      {{"/simulation", {{"seed", 1}}},
       {"/decision_rule/rule", "iso-14253-1"},
       {"/uncertainty",
        {{"most_trials", 2000}, {"budget_trials", 0}, {"probe", {{"repeatability_um", 0}}}}}});
  ASSERT_EQ(run.outcome.status, 0) << run.outcome.err << run.outcome.out;
  EXPECT_LT(run.value_um(), 1e-6);
  EXPECT_EQ(rondure({"verify", run.folder / "run"}).status, 0);
}

TEST(HardPlan, AnEmptySimulationIsATypicalPartOnATypicalMachine) {
  const HardRun run({{"/simulation", json::object()}});
  ASSERT_LE(run.outcome.status, 1) << run.outcome.err << run.outcome.out;
  EXPECT_GT(run.truth_um(), 0.8);
  EXPECT_LT(run.truth_um(), 4.0);
  EXPECT_GT(run.value_um(), 0.8);
  EXPECT_EQ(rondure({"verify", run.folder / "run"}).status, 0);
}

TEST(HardPlan, APartOfAnotherSizeIsNotMeasured) {
  const HardRun run({{"/simulation/part/diameter_error_um", -1000},
                     {"/simulation/part/tilt_deg", 0},
                     {"/simulation/part/offset_x_mm", 0},
                     {"/simulation/part/offset_y_mm", 0},
                     {"/part/location_uncertainty_mm", 0.4}});
  EXPECT_EQ(run.outcome.status, 3);
  EXPECT_THAT(run.outcome.err,
              AllOf(HasSubstr("[location]"), HasSubstr("radius"), HasSubstr("0.4 mm")));
}

TEST(HardPlan, WithoutAQualificationTheVerdictIsVoid) {
  const HardRun run({});
  record::RunRecord record = journal_of(run.folder / "run");
  ASSERT_EQ(evaluation::evaluate(record)->verdict, evaluation::Verdict::kConforms);
  record::RunRecord unqualified = record;
  std::erase_if(unqualified.touches, [](const record::Touch& touch) {
    return touch.purpose == record::Touch::Purpose::kQualification;
  });
  EXPECT_EQ(evaluation::evaluate(unqualified)->verdict, evaluation::Verdict::kVoid);
  record.artefact.form_limit_mm = 1e-6;
  EXPECT_EQ(evaluation::evaluate(record)->verdict, evaluation::Verdict::kVoid);
}

TEST(HardPlan, OneTouchBeyondTheTemperatureLimitsIsEnough) {
  const HardRun run({});
  record::RunRecord record = journal_of(run.folder / "run");
  record.touches.back().temperature_degC = 22.5;
  EXPECT_EQ(evaluation::evaluate(record)->verdict, evaluation::Verdict::kVoid);
}

TEST(HardPlan, AFeatureThatFailsIsNeverPassedOver) {
  const Scratch folder;
  write(folder / "line.csv", "x,y,z\n0,0,0\n1,1,1\n2,2,2\n3,3,3\n4,4,4\n5,5,5\n");
  write(folder / "plan.json",
        R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},
            "features": [{"id": "f", "type": "cylinder", "source": {"file": "line.csv"}}]})");
  const Outcome outcome = rondure({"run", folder / "plan.json", "--out", folder / "run"});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(::testing::StartsWith("Void\n"), HasSubstr("collinear")));
}

TEST(HardPlan, AnArcFromAFileIsCalledAnArc) {
  const Scratch folder;
  std::string csv = "x,y\n";
  for (int k = 0; k < 30; ++k) {
    const double a = 0.02 * k;
    csv += std::to_string(25.0 * std::cos(a)) + "," + std::to_string(25.0 * std::sin(a)) + "\n";
  }
  write(folder / "arc.csv", csv);
  write(folder / "plan.json",
        R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},
            "features": [{"id": "f", "type": "circle", "source": {"file": "arc.csv"}}]})");
  const Outcome outcome =
      rondure({"run", folder / "plan.json", "--out", folder / "run", "--verbose"});
  EXPECT_THAT(outcome.out, HasSubstr("not-full-section")) << outcome.err;
}

}  // namespace
}  // namespace rondure::app::testing
