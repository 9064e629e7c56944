#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "evaluation/results/finding.h"
#include "plans/analyses/analysis.h"
#include "plans/analyses/features.h"
#include "plans/run/internal/run_head.h"
#include "plans/schema/json_text.h"
#include "random_inspection.h"
#include "record/tasks/form_facts.h"
#include "record/tasks/settings.h"
#include "record/tasks/surface.h"
#include "tests/core/scratch.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using record::Form;
using record::Indication;
using record::Shape;
using testing::bytes_of;
using testing::lines_of;

std::filesystem::path shaft_folder() { return testing::source_dir() / "tests/data/shaft_drawing"; }

/// The plans of docs/drawing.md: of points from a file, and of touches.
std::string documented_plan(int number = 0) {
  const std::string page = bytes_of(testing::source_dir() / "docs/drawing.md");
  const std::string fence = "```json\n";
  std::size_t at = page.find(fence) + fence.size();
  for (int k = 0; k < number; ++k) at = page.find(fence, at) + fence.size();
  return page.substr(at, page.find("```", at) - at);
}

/// Problems of that plan with one text replaced everywhere.
std::string problems_with(const std::string& text, const std::string& other) {
  std::string plan = documented_plan();
  std::size_t at = plan.find(text);
  EXPECT_NE(at, std::string::npos) << text;
  for (; at != std::string::npos; at = plan.find(text, at + other.size())) {
    plan.replace(at, text.size(), other);
  }
  return lines_of(parse_plan(plan, shaft_folder(), "plan.json"));
}

/// A touched cylinder; `keys` and `characteristics` are spliced in.
PlanOrProblems touched_cylinder(const std::string& characteristics, const std::string& keys = "") {
  return parse_plan(
      R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},
      "machine": {}, "fixture": {},
      "probe": {}, "simulation": {}, "features": [{"id": "A", "type": "cylinder",
      "nominal": {"diameter_mm": 50, "from_mm": -40, "to_mm": 40},)" +
          keys + R"("characteristics": [)" + characteristics + "]}]}",
      "", "plan.json");
}

TEST(PlanDrawing, TheShaftOfTheDocumentIsAPlan) {
  const auto plan = parse_plan(documented_plan(), shaft_folder(), "plan.json");
  ASSERT_TRUE(plan) << lines_of(plan);
  const record::RunRecord head = run_head(*plan, {}, 0);
  std::size_t call_outs = 0;
  for (const record::Feature& feature : head.features) call_outs += feature.characteristics.size();
  EXPECT_EQ(call_outs, 14U);
  const record::Feature& a = head.features.front();
  const record::Characteristic& envelope = a.characteristics.front();
  EXPECT_EQ(envelope.indication.requirement, Indication::Requirement::kEnvelope);
  EXPECT_DOUBLE_EQ(envelope.lower_mm.value(), 29.987);
  EXPECT_EQ(envelope.tolerance_mm, 30.0);
  EXPECT_EQ(a.characteristics[3].indication.filter, Indication::Filter::kGaussian);
  EXPECT_EQ(a.characteristics[4].indication.filter, Indication::Filter::kNone);
  const auto surface = record::task_of<record::SurfaceSettings>(a.settings);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->letter, "A");
  EXPECT_EQ(surface->clamping, "shaft.csv") << "one file is one clamping";
  ASSERT_EQ(surface->exclude.size(), 1U);
  EXPECT_EQ(surface->exclude.front().to_deg, 95.0);
  EXPECT_FALSE(surface->exclude.front().guard_mm) << "absent is not 0";
}

TEST(PlanDrawing, RowsOfOneFileThatNameTwoClampingsAreNotRelated) {
  const std::string seat = R"("feature": "C",)";
  EXPECT_EQ(problems_with(seat, seat + R"("clamping": "one",)"), "") << "the others inherit it";
  std::string plan = documented_plan();
  plan.replace(plan.find(seat), seat.size(), seat + R"("clamping": "two",)");
  const std::string journal = R"("feature": "A",)";
  plan.replace(plan.find(journal), journal.size(), journal + R"("clamping": "one",)");
  EXPECT_THAT(lines_of(parse_plan(plan, shaft_folder(), "plan.json")),
              ::testing::HasSubstr("\"seat C\" and \"journal B\" are of one file and of the "
                                   "clampings \"two\" and \"shaft.csv\""));
}

TEST(PlanDrawing, RowsThatNoFeatureTakesAreRefused) {
  const test::Scratch folder;
  std::string text = bytes_of(shaft_folder() / "shaft.csv");
  const auto lines = std::count(text.begin(), text.end(), '\n');
  const auto problems = [&](const std::string& rows) {
    EXPECT_TRUE(record::write_file(folder / "shaft.csv", text + rows));
    return lines_of(parse_plan(documented_plan(), folder.path(), "plan.json"));
  };
  EXPECT_EQ(problems(""), "");
  EXPECT_EQ(
      problems("1,2,3,0,c\n1,2,3,0,\"A\"\n1,2,3,0,\"C c\"\n4,5,6,0,c\n"),
      fmt::format("/features/0/source/feature: the file \"shaft.csv\" has rows that no feature "
                  "of the plan takes: {} (2 rows from line {} on), {} (1 rows from line {} "
                  "on); correct the names, which count letter by letter, plan a feature for "
                  "them, take them out, or say \"others\": \"left-out\" [meaning]\n",
                  in_quotes("c"), lines + 1, in_quotes("C c"), lines + 3));
}

// 30 mm in inches, in metres and in micrometres; nothing but the nominal tells the unit.
TEST(PlanDrawing, ASizeThatLooksLikeAnotherUnitNeedsItsNominal) {
  const test::Scratch folder;
  const auto problems = [&](double factor, const std::string& more) {
    std::string text = "x,y,z\n";
    for (int k = 0; k < 8; ++k) {
      const double angle = core::kTwoPi * k / 8.0;
      text += fmt::format("{},{},{}\n", factor * (3.0 + 15.0 * std::cos(angle)),
                          factor * 15.0 * std::sin(angle), factor * 7.0);
    }
    EXPECT_TRUE(record::write_file(folder / "c.csv", text));
    return lines_of(parse_plan(R"({"plan": {"name": "c", "revision": "A"}, "part": {"id": "c"},
      "features": [{"id": "c", "type": "circle", )" +
                                   more + R"("source": {"file": "c.csv"}, "characteristics": [
      {"id": "r", "form": "roundness", "tolerance_um": 5}]}]})",
                               folder.path(), "plan.json"));
  };
  EXPECT_EQ(problems(1.0, ""), "");
  EXPECT_THAT(
      problems(1.0 / 25.4, ""),
      ::testing::HasSubstr("/features/0/source/file: the points of \"c.csv\" show a "
                           "diameter of 1.1811: in mm that is 1.1811 mm, in inches 30 mm; "
                           "state the unit: --unit inch or --unit mm, in a plan source.unit or "
                           "nominal.diameter_mm"));
  EXPECT_THAT(problems(1e-3, ""), ::testing::HasSubstr(", in metres 30 mm; state"));
  EXPECT_THAT(problems(1e3, ""), ::testing::HasSubstr(", in micrometres 30 mm; state"));
  EXPECT_EQ(problems(0.2, R"("nominal": {"diameter_mm": 6}, )"), "");
}

TEST(PlanDrawing, ACutOffBelowTwoLeavesNoForm) {
  EXPECT_EQ(problems_with(R"("cutoff_upr": 50)", R"("cutoff_upr": 2)"), "");
  EXPECT_THAT(problems_with(R"("cutoff_upr": 50)", R"("cutoff_upr": 1.9)"),
              ::testing::HasSubstr("/features/0/characteristics/3/cutoff_upr: a cut-off of 1.9 UPR "
                                   "leaves no form"));
}

TEST(PlanDrawing, AFeatureOfTheSameRowsIsNoDatum) {
  std::string plan = documented_plan();
  const std::string rows = R"("feature": "B")";
  plan.replace(plan.find(rows), rows.size(), R"("feature": "C")");
  EXPECT_THAT(lines_of(parse_plan(plan, shaft_folder(), "plan.json")),
              ::testing::HasSubstr("\"journal B\" and \"seat C\" take the same rows of one file"));
}

TEST(PlanDrawing, TheTouchedShaftOfTheDocumentIsMeasured) {
  const auto plan = parse_plan(documented_plan(1), "", "plan.json");
  ASSERT_TRUE(plan) << lines_of(plan);
  const auto run = test::inspect(*plan);
  const auto& a = run.evaluation.features.front().characteristics;
  ASSERT_EQ(a.size(), 2U);
  ASSERT_TRUE(a.front().finding);
  EXPECT_NEAR(a.front().finding->judged.front().value_mm, 29.994, 1e-6);
  EXPECT_EQ(a.front().finding->left_out.size(), 1U) << "one touch lies in the keyway";
  const auto& c = run.evaluation.features.back().characteristics;
  ASSERT_EQ(c.size(), 2U);
  ASSERT_TRUE(c.back().finding);
  EXPECT_NEAR(c.back().finding->judged.front().value_mm, 0.008, 1e-5) << "twice the offset";
}

/// Points of one journal as a German program writes them.
std::string german_export() {
  std::istringstream rows(bytes_of(testing::source_dir() / "plans/examples/15_shaft.csv"));
  std::string out = "Punkt;X-Ist [mm];Y-Ist [mm];Z-Ist [mm]\n";
  int number = 0;
  for (std::string row; std::getline(rows, row);) {
    if (!row.starts_with("journal B,")) continue;
    std::string point = row.substr(row.find(',', row.find(',') + 1) + 1);
    std::ranges::replace(point, ',', ';');
    std::ranges::replace(point, '.', ',');
    out += std::to_string(++number) + ";" + point + "\n";
  }
  return out;
}

TEST(PlanDrawing, PlansOfTheFirstPagesAreValid) {
  const test::Scratch folder;
  for (const char* name : {"export.csv", "your_points.csv"}) {
    ASSERT_TRUE(record::write_file(folder / name, german_export()));
  }
  for (const char* page : {"README.md", "docs/first-result.md", "docs/first-plan.md"}) {
    SCOPED_TRACE(page);
    const std::string text = bytes_of(testing::source_dir() / page);
    const std::size_t at = text.find("```json\n") + 8;
    const auto plan =
        parse_plan(text.substr(at, text.find("```", at) - at), folder.path(), "plan.json");
    EXPECT_TRUE(plan) << lines_of(plan);
  }
}

TEST(PlanDrawing, EachCallOutOfTheDocumentIsWrittenWithWordsOfThePlan) {
  const std::string page = bytes_of(testing::source_dir() / "docs/drawing.md");
  for (const record::FormFacts& facts : record::kFormFacts) {
    const bool of_surface =
        facts.shapes.contains(Shape::kCylinder) || facts.shapes.contains(Shape::kPlane);
    if (!of_surface) continue;
    EXPECT_THAT(page, ::testing::HasSubstr(std::string(name_of(facts.form))));
  }
}

TEST(PlanDrawing, TouchedCylindersMayHaveEachFormThatNeedsNoDatum) {
  const std::string sampling = R"("sampling": {"layers": 4, "points_per_layer": 8, "stagger": 0},)";
  const auto plan = touched_cylinder(
      R"({"id": "1", "form": "diameter", "size": "GN", "lower_um": -13, "upper_um": 0},
         {"id": "2", "form": "diameter", "requirement": "envelope", "lower_um": -13,
          "upper_um": 0},
         {"id": "3", "form": "straightness", "reference": "ls", "tolerance_um": 2},
         {"id": "4", "form": "straightness", "of": "median-line", "tolerance_um": 2},
         {"id": "5", "form": "taper"}, {"id": "6", "form": "generatrix-parallelism"},
         {"id": "7", "form": "cylindricity", "parameter": "rms", "tolerance_um": 2},
         {"id": "8", "form": "diameter", "rank": "SR", "tolerance_um": 5})",
      sampling);
  ASSERT_TRUE(plan) << lines_of(plan);
  const record::RunRecord head = run_head(*plan, {}, 0);
  const record::Feature& feature = head.features.front();
  EXPECT_EQ(feature.characteristics[6].reference, record::Reference::kLeastSquares);
  EXPECT_DOUBLE_EQ(feature.characteristics[7].tolerance_mm.value(), 0.005);
  const auto surface = record::task_of<record::SurfaceSettings>(feature.settings);
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->first_layer_mm, -35.0);
}

TEST(PlanDrawing, ADatumMayBeTouched) {
  const auto plan = parse_plan(
      R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},
          "machine": {}, "fixture": {}, "probe": {},
          "simulation": {}, "features": [
          {"id": "low-end", "type": "cylinder",
           "nominal": {"diameter_mm": 50, "from_mm": -40, "to_mm": 0}},
          {"id": "B", "type": "cylinder", "nominal": {"diameter_mm": 50, "from_mm": 10, "to_mm": 40},
           "characteristics": [{"id": "1", "form": "coaxiality", "datum": ["low-end"]}]}]})",
      "", "plan.json");
  ASSERT_TRUE(plan) << lines_of(plan) << "an id may hold a hyphen";
  for (const FeaturePlan& feature : plan->features) {
    EXPECT_EQ(feature.pose_search.strategy, record::Strategy::kStartPose) << feature.id;
  }
  const auto alone = touched_cylinder(R"({"id": "c", "form": "cylindricity"})");
  ASSERT_TRUE(alone) << lines_of(alone);
  EXPECT_EQ(alone->features.front().pose_search.strategy, record::Strategy::kGuided);
}

TEST(PlanDrawing, AToleranceWithoutReferenceIsAboutTheMinimumZone) {
  const auto plan = touched_cylinder(R"({"id": "c", "form": "cylindricity", "tolerance_um": 12})");
  ASSERT_TRUE(plan) << lines_of(plan);
  EXPECT_EQ(run_head(*plan, {}, 0).features[0].characteristics[0].reference,
            record::Reference::kMinimumZone);
}

TEST(PlanDrawing, ARuleOfACharacteristicIsCheckedAsThatOfThePlan) {
  const auto plan = touched_cylinder(R"({"id": "1", "form": "cylindricity", "reference": "mz",
      "tolerance_um": 4, "decision_rule": {"rule": "n-to-1", "guard_factor": 2}})");
  ASSERT_FALSE(plan);
  std::vector<std::string> places;
  for (const core::Error& problem : plan.error()) places.push_back(problem.where);
  const std::string rule = "/features/0/characteristics/0/decision_rule/";
  EXPECT_THAT(places, ::testing::IsSupersetOf(
                          {rule + "zones", rule + "guard_factor", std::string("/uncertainty")}));
}

TEST(PlanDrawing, APriorIsNotOfSizes) {
  const std::string rule =
      R"("decision_rule": {"prior": {"mean_um": 3, "standard_deviation_um": 1}},)";
  const auto plan =
      touched_cylinder(R"({"id": "1", "form": "diameter", "size": "GG", "upper_um": 4})", rule);
  ASSERT_FALSE(plan);
  EXPECT_THAT(plan.error().front().what, ::testing::HasSubstr("the prior describes form"));
  EXPECT_TRUE(touched_cylinder(
      R"({"id": "1", "form": "diameter", "size": "GG", "upper_um": 4, "decision_rule": {}})",
      rule));
}

TEST(FormFacts, AgreeWithTheAnalyses) {
  for (const auto& shape : words_of(Shape{})) {
    const AnalysisKind* const kind = analysis_kind(shape.value);
    if (kind == nullptr) continue;
    for (const record::FormFacts& facts : record::kFormFacts) {
      const bool listed =
          std::find(kind->forms.begin(), kind->forms.end(), facts.form) != kind->forms.end();
      EXPECT_EQ(facts.shapes.contains(shape.value), listed)
          << shape.text << " " << name_of(facts.form);
    }
  }
}

}  // namespace
}  // namespace rondure::plans
