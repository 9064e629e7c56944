#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "core/numbers.h"
#include "core/units.h"
#include "tests/core/scratch.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using core::Code;
using testing::example;
using testing::lines_of;

// A touched plan; `feature` and `sections` are spliced in, e.g. "\"sampling\": {...},".
std::string touched(const std::string& feature = "", const std::string& sections = "") {
  return R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},)" + sections +
         R"("probe": {}, "features": [{"id": "f", "type": "cylinder",)" + feature +
         R"("nominal": {"diameter_mm": 50, "from_mm": -40, "to_mm": 40}}], "simulation": {}})";
}

const std::string kMachines = R"("machine": {}, "fixture": {},)";

PlanOrProblems parse(const std::string& text) { return parse_plan(text, "", "plan.json"); }

// The only problem of a text.
core::Error only_problem(const std::string& text) {
  const PlanOrProblems result = parse(text);
  if (result) return {Code::kInternal, "no problem was found", ""};
  if (result.error().size() != 1) return {Code::kInternal, lines_of(result), ""};
  return result.error().front();
}

TEST(PlanReader, EveryExampleIsAPlan) {
  const auto plans = testing::plans_in(example(""));
  EXPECT_EQ(plans.size(), 23U);
  for (const auto& path : plans) EXPECT_EQ(lines_of(read_plan(path)), "") << path.filename();
}

TEST(PlanReader, ANameThatNoReportCanShowIsRefused) {
  for (const std::string name : {"A\\uFFFE", "A\uFDD0", "A\\u001b[2J", "A\u009b2J", "A\x7f"}) {
    std::string text = touched("", kMachines);
    text.replace(text.find("\"p\""), 3, "\"" + name + "\"");
    const core::Error problem = only_problem(text);
    EXPECT_EQ(problem.where, "/part/id") << problem.what;
    EXPECT_EQ(problem.code, Code::kOutOfRange);
    EXPECT_NE(problem.what.find("which no report can show; remove it"), std::string::npos)
        << problem.what;
  }
}

TEST(PlanReader, InEveryExampleTheSimulatedPartStandsWhereThePlanExpectsIt) {
  for (const auto& path : testing::plans_in(example(""))) {
    const PlanOrProblems result = read_plan(path);
    ASSERT_TRUE(result) << path;
    if (!result->simulation) continue;
    const SimulatedPartPlan& part = result->simulation->part;
    const NominalPlan& nominal = result->features.front().nominal;
    const double half_length_mm = (nominal.to_mm - nominal.from_mm) / 2.0;
    const double shift_mm = half_length_mm * std::tan(part.tilt_deg * core::kDegree) +
                            std::hypot(part.offset_x_mm, part.offset_y_mm);
    EXPECT_LT(shift_mm, result->part.location_uncertainty_mm) << path;
  }
}

TEST(PlanReader, TheSpoolIsReadWithEveryValue) {
  const PlanOrProblems result = read_plan(example("01_spool_simulated.json"));
  ASSERT_TRUE(result) << lines_of(result);
  EXPECT_EQ(result->plan.revision, "A");
  EXPECT_EQ(result->part.location_uncertainty_mm, 2.0);
  EXPECT_EQ(result->fixture->axis_offset_mm, (std::array<double, 3>{0.4, -0.3, 12.0}));
  EXPECT_EQ(result->probe->qualification.sphere_diameter_mm, 25.0012);
  ASSERT_EQ(result->features.size(), 1U);
  const FeaturePlan& feature = result->features[0];
  EXPECT_EQ(feature.nominal.from_mm, -40.0);
  EXPECT_EQ(feature.sampling.points_per_layer, 7);
  ASSERT_EQ(feature.characteristics.size(), 3U);
  EXPECT_EQ(feature.characteristics[1].tolerance_um, 8.0);
  EXPECT_EQ(feature.characteristics[2].reference, record::Reference::kLeastSquares);
  EXPECT_FALSE(feature.characteristics[2].tolerance_um.has_value());
  EXPECT_EQ(result->simulation->seed, 20261121U);
  ASSERT_EQ(result->simulation->part.lobes.size(), 3U);
  EXPECT_EQ(result->simulation->part.lobes[1].twist_deg, -40.0);
  EXPECT_EQ(result->folder, example("").parent_path());
}

TEST(PlanReader, ThePlanKeepsItsTextByteForByte) {
  const auto path = example("01_spool_simulated.json");
  const PlanOrProblems result = read_plan(path);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->text, testing::bytes_of(path));
}

TEST(PlanReader, AKeyLeftOutHasTheDefaultOfItsStruct) {
  const PlanOrProblems result = parse(touched("", kMachines));
  ASSERT_TRUE(result) << lines_of(result);
  const FeaturePlan defaults;
  EXPECT_EQ(result->features[0].sampling.layers, defaults.sampling.layers);
  EXPECT_EQ(result->features[0].pose_search.steps_deg, defaults.pose_search.steps_deg);
  EXPECT_EQ(result->machine->park_mm, MachinePlan().park_mm);
  EXPECT_FALSE(result->environment) << "its defaults hold for what is touched";
  EXPECT_EQ(result->reports.formats, ReportsPlan().formats);
}

TEST(PlanReader, AnAssumedTemperatureLiesWithinTheLimits) {
  const std::string limits = kMachines + R"("environment": {"max_degC": 23, "assumed_degC": )";
  const PlanOrProblems result = parse(touched("", limits + "22.5},"));
  ASSERT_TRUE(result) << lines_of(result);
  EXPECT_EQ(result->environment->assumed_degC, 22.5);
  const core::Error problem = only_problem(touched("", limits + "24},"));
  EXPECT_EQ(problem.where, "/environment/assumed_degC");
  EXPECT_EQ(problem.what,
            "24 degC is outside the limits 18..23 degC of this plan; every result would be void");
}

/// A spindle plan with these declared influences and a rule that needs an interval.
std::string declaring(const std::string& influences) {
  return R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},
    "features": [{"id": "f", "type": "spindle", "spindle": {"layout": "reference",
      "uncertainty": {)" +
         influences + R"(}},
      "characteristics": [{"id": "c", "form": "roundness-rms", "tolerance_um": 5}]}],
    "decision_rule": {"rule": "iso-14253-1"}, "simulation": {"spindle": {}}})";
}

TEST(PlanReader, AnInfluenceIsANumberOrAnObjectWithItsDistribution) {
  const PlanOrProblems result = parse(declaring(
      R"("noise_um": 0.05, "gain_1": {"value": 0.002}, "encoder_urad": 0,
         "line_um": {"value": 30, "distribution": "rectangular"})"));
  ASSERT_TRUE(result) << lines_of(result);
  const record::SpindleInfluencesTask& declared = *result->features[0].spindle->uncertainty;
  EXPECT_EQ(record::u_of(declared.noise_um), 0.05);
  EXPECT_EQ(record::u_of(declared.gain_1), 0.002);
  ASSERT_TRUE(declared.encoder_urad);
  EXPECT_EQ(declared.encoder_urad->value, 0.0);
  EXPECT_NEAR(record::u_of(declared.line_um), 17.3205, 1e-4);
  EXPECT_FALSE(declared.angle_deg);
}

TEST(PlanReader, ARuleThatJudgesOnlyAnalysesNeedsNoSectionUncertainty) {
  EXPECT_TRUE(parse(declaring(R"("noise_um": 0.05)"))) << "its influences stand with the feature";
  const core::Error problem =
      only_problem(touched("", kMachines + R"("decision_rule": {"rule": "iso-14253-1"},)"));
  EXPECT_EQ(problem.where, "/uncertainty");
}

TEST(PlanReader, AnArrayInThePlanReplacesTheDefault) {
  const PlanOrProblems result = parse(touched(R"("pose_search": {"steps_deg": [1]},)", kMachines));
  ASSERT_TRUE(result) << lines_of(result);
  EXPECT_EQ(result->features[0].pose_search.steps_deg, std::vector<double>{1.0});
}

TEST(PlanReader, ACircleIsOneLayerOfItsSurface) {
  const PlanOrProblems result =
      parse(R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"},)" + kMachines +
            R"("probe": {}, "features": [{"id": "f", "type": "circle",
          "nominal": {"diameter_mm": 50, "from_mm": -12.5, "to_mm": 7.5}}], "simulation": {}})");
  ASSERT_TRUE(result) << lines_of(result);
  EXPECT_EQ(result->features[0].sampling.layers, 1);
}

TEST(PlanReader, ByteOrderMarkCrLfAndSchemaKeyAreAccepted) {
  std::string text =
      "\xEF\xBB\xBF" + touched("", "\r\n\"$schema\": \"plan.schema.json\",\r\n" + kMachines);
  EXPECT_EQ(lines_of(parse(text)), "");
}

TEST(PlanReader, AWholeNumberMayBeWrittenWithAPoint) {
  const PlanOrProblems result = parse(touched(R"("sampling": {"layers": 6.0},)", kMachines));
  ASSERT_TRUE(result) << lines_of(result);
  EXPECT_EQ(result->features[0].sampling.layers, 6);
}

TEST(PlanReader, LimitsThemselvesAreAllowedOnlyWhenTheTableSaysSo) {
  const auto with_tip = [](const std::string& tip_mm) {
    std::string text = touched("", kMachines);
    return text.replace(text.find("\"probe\": {}"), 11,
                        "\"probe\": {\"tip_diameter_mm\": " + tip_mm + "}");
  };
  EXPECT_EQ(lines_of(parse(with_tip("50"))), "");
  EXPECT_EQ(only_problem(with_tip("50.001")).code, Code::kOutOfRange);
  EXPECT_EQ(only_problem(with_tip("0")).code, Code::kOutOfRange);
  EXPECT_EQ(lines_of(parse(with_tip("1e-9"))), "");
}

TEST(PlanReader, LayersMayTouchTheEndsButNotTheClampedBand) {
  const auto with_clamp = [](double from_mm, double to_mm) {
    return touched(R"("sampling": {"layers": 3, "margin_mm": 0},)",
                   R"("machine": {}, "fixture": {"clamp_from_mm": )" + core::shortest(from_mm) +
                       R"(, "clamp_to_mm": )" + core::shortest(to_mm) + "},");
  };
  // Layers at -40, 0, 40. Between two layers the band holds none, but the tip cannot pass it.
  EXPECT_EQ(only_problem(with_clamp(0.001, 39.999)).code, Code::kUnreachable);
  EXPECT_EQ(only_problem(with_clamp(0.0, 39.999)).code, Code::kSampling);
  EXPECT_EQ(only_problem(with_clamp(0.001, 40.0)).code, Code::kSampling);
  EXPECT_EQ(lines_of(parse(with_clamp(5.0, -5.0))), "");  // no band
}

TEST(PlanReader, ABoreMustLeaveTheTipRoomToSearch) {
  const auto bore = [](const std::string& uncertainty_mm) {
    return R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p", "location_uncertainty_mm": )" +
           uncertainty_mm + "}," + kMachines +
           R"("probe": {"tip_diameter_mm": 4}, "features": [{"id": "f", "type": "cylinder", "side": "inside",
              "nominal": {"diameter_mm": 14, "from_mm": -20, "to_mm": 20}}], "simulation": {}})";
  };
  EXPECT_EQ(lines_of(parse(bore("2"))), "");  // 3 mm approach + 2 mm in a way of 5 mm
  EXPECT_EQ(only_problem(bore("2.001")).code, Code::kUnreachable);
}

TEST(PlanReader, AMeaningIsNotJudgedFromValuesThatAreThemselvesWrong) {
  const core::Error problem =
      only_problem(touched(R"("sampling": {"layers": "1", "margin_mm": 40},)", kMachines));
  EXPECT_EQ(problem.code, Code::kWrongType);
  EXPECT_EQ(problem.where, "/features/0/sampling/layers");
}

TEST(PlanReader, AMissingPlanAndAFolderAreFileErrors) {
  for (const char* name : {"no_such_plan.json", "03_calibration"}) {
    const PlanOrProblems result = read_plan(example(name));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().front().code, Code::kFile);
  }
}

TEST(PlanReader, AFileBeyondTenMegabytesIsNotRead) {
  const test::Scratch folder;
  const auto path = folder / "rondure_large_plan.json";
  std::ofstream(path) << std::string(10'000'001, ' ');
  const PlanOrProblems result = read_plan(path);
  ASSERT_FALSE(result);
  EXPECT_EQ(lines_of(result),
            "rondure_large_plan.json: the file has 10000001 bytes, the limit is 10000000; this is "
            "not a plan [syntax]\n");
}

TEST(PlanReader, AHundredThousandLevelsOfBracketsAreRefusedNotFollowed) {
  EXPECT_EQ(only_problem(std::string(100'000, '[')).code, Code::kSyntax);
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  EXPECT_EQ(only_problem(objects).code, Code::kSyntax);
}

TEST(PlanReader, AFileOfTooManyValuesIsRefused) {
  std::string text = "{\"a\": [0";
  for (int i = 0; i < 100'000; ++i) text += ",0";
  EXPECT_EQ(only_problem(text + "]}").code, Code::kSyntax);
}

TEST(PlanReader, FortyThousandMisspeltKeysAreAllReported) {
  std::string text = "{\"plan\": {\"name\": \"n\"";
  for (int i = 0; i < 40'000; ++i) text += ", \"revision" + std::to_string(i) + "\": 1";
  const PlanOrProblems result = parse(text + "}}");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().size(), 40'000U + 3U);  // part, features and plan.revision are missing
}

}  // namespace
}  // namespace rondure::plans
