#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <sstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/files.h"
#include "tests/app/program.h"
#include "tests/plans/stl_files.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::size_t longest_line(const std::string& text) {
  std::size_t out = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out = std::max(out, line.size());
  return out;
}

/// The words of a text with single blanks between them.
std::string unbroken(const std::string& text) {
  std::string out;
  std::istringstream words(text);
  for (std::string word; words >> word;) out += (out.empty() ? "" : " ") + word;
  return out;
}

TEST(PlanVerb, TellsStagesTimeAndPathInEightyColumns) {
  const Scratch folder;
  write_plan(folder / "plan.json", {});
  const Outcome told = rondure({"plan", folder / "plan.json"});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out,
              AllOf(HasSubstr("qualification"), HasSubstr("location"), HasSubstr("final cloud x 5"),
                    HasSubstr("total"), HasSubstr("each further pose 28 touches"),
                    HasSubstr("Nothing has moved.")));
  EXPECT_LE(longest_line(told.out), 80U);
  EXPECT_EQ(told.err, "");
}

TEST(PlanVerb, TellsTheSameAsJson) {
  const Outcome told = rondure({"plan", example("14_bore_simulated.json"), "--json"});
  ASSERT_EQ(told.status, 0) << told.err;
  const auto document = nlohmann::json::parse(told.out);
  EXPECT_EQ(document["touches"], 13 + 6 + 3 * 45);
  ASSERT_EQ(document["stages"].size(), 3U);
  EXPECT_EQ(document["stages"][2]["final"], true);
  double time_s = 0.0;
  for (const auto& stage : document["stages"]) time_s += stage["time_s"].get<double>();
  EXPECT_NEAR(document["time_s"].get<double>(), time_s, 1e-9);
}

TEST(PlanVerb, DrawsAPicture) {
  const Scratch folder;
  write_plan(folder / "plan.json", {});
  const Outcome told = rondure({"plan", folder / "plan.json", "--svg", folder / "way.svg"});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(read(folder / "way.svg"),
              AllOf(StartsWith("<svg "), HasSubstr("From the side"), HasSubstr("</svg>")));
  const Outcome absent =
      rondure({"plan", folder / "plan.json", "--svg", folder / "x.svg", "--feature", "bore"});
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.err, HasSubstr("no touched feature has the id bore"));
}

TEST(PlanVerb, NamesWhatIsOutOfReachAndMovesNothing) {
  const Scratch folder;
  write_plan(folder / "plan.json", {{"/fixture/rim_height_mm", 130}});
  const Outcome told = rondure({"plan", folder / "plan.json", "--json"});
  EXPECT_EQ(told.status, 2);
  EXPECT_THAT(told.err, AllOf(HasSubstr("/features/0/sampling: layer 1, point 1 (0.0 deg)"),
                              HasSubstr("the rim of the bowl"), HasSubstr("[unreachable]")));
  const auto document = nlohmann::json::parse(told.out);
  EXPECT_EQ(document["problems"][0]["code"], "unreachable");
}

TEST(PlanVerb, RefusesWithValidateAndRunASphereThatHidesAnother) {
  auto plan = example_plan("01_spool_simulated");
  plan["fixture"]["driver"] = "manual";
  plan["fixture"]["reached_pose"]["spheres"] = {{{"center_mm", {70, 0, -40}}},
                                                {{"center_mm", {-35, 60, -40}}},
                                                {{"center_mm", {-35, 85, -30}}}};
  const Scratch folder;
  write(folder / "plan.json", plan.dump());
  for (const char* verb : {"validate", "plan", "run"}) {
    SCOPED_TRACE(verb);
    std::vector<std::string> words = {verb, folder / "plan.json"};
    if (words[0] == "run") words.insert(words.end(), {"--out", folder / "run"});
    const Outcome refused = rondure(words);
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr("pose (0.0000, 0.0000) deg, sphere 2 on the ring, point "),
                      HasSubstr("to a sphere on the ring"), HasSubstr("[unreachable]")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "run"));
}

TEST(PlanVerb, SaysWithValidateWhereNothingIsKnownOfWhatHoldsThePart) {
  auto plan = example_plan("17_cmm_without_fixture");
  leave_out_intervals(plan);
  const Scratch folder;
  for (const bool known : {true, false}) {
    if (!known) plan["part"].erase("held");
    write(folder / "plan.json", plan.dump());
    for (const char* verb : {"validate", "plan"}) {
      const Outcome told = rondure({verb, folder / "plan.json"});
      EXPECT_EQ(told.status, 0) << told.err;
      EXPECT_EQ(told.out.find("clamps and jaws are not checked") == std::string::npos, known)
          << told.out;
    }
  }
}

TEST(PlanVerb, HasNothingToMoveForPointsFiles) {
  const Outcome told = rondure({"plan", example("09_axle_points_file.json")});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("nothing would move"));
}

TEST(PlanVerb, SaysHowManyQuestionsOfTheClearanceMeshesAnswered) {
  const auto asked = [](const std::filesystem::path& plan) {
    const Outcome told = rondure({"plan", plan, "--json"});
    return nlohmann::json::parse(told.out).at("clearance");
  };
  const auto found = asked(example("18_calibrate_and_inspect.json"));
  const auto questions = found.at("questions").get<double>();
  const auto on_meshes = found.at("on_meshes").get<double>();
  std::cout << found << "\n";
  EXPECT_GT(questions, 10'000.0);
  EXPECT_GT(on_meshes, 0.0);
  EXPECT_LT(on_meshes, 0.5 * questions) << "closed forms answer most";
  EXPECT_EQ(asked(example("18_calibrate_and_inspect.json")), found);
  EXPECT_THAT(rondure({"plan", example("18_calibrate_and_inspect.json")}).out,
              HasSubstr(fmt::format("\nClearance: {} questions, {:.2g} % answered on meshes\n",
                                    questions, 100.0 * on_meshes / questions)));
  EXPECT_THAT(rondure({"plan", example("01_spool_simulated.json")}).out,
              Not(HasSubstr("Clearance:")));
}

// As near to the spool as its touches allow, and higher.
TEST(PlanVerb, ABodyOfTwentyThousandTrianglesTakesLessThanTwoSeconds) {
  const Scratch folder;
  const auto used_s = [] {
    rusage used = {};
    ::getrusage(RUSAGE_CHILDREN, &used);
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
  };
  const test::Soup stand = test::cylinder_soup(20.0, 0.0, 300.0, 100, 99);
  ASSERT_EQ(stand.corners.size(), 20'000U);
  write(folder / "stand.stl", test::stl_text(stand));
  write_plan(folder / "plan.json", {{"/fixture/bodies",
                                     {{{"id", "stand"},
                                       {"shape", "mesh"},
                                       {"file", "stand.stl"},
                                       {"unit", "mm"},
                                       {"facets", "round"},
                                       {"position_mm", {45, 45, 0}}}}}});
  const double before_s = used_s();
  const Outcome told = rondure({"plan", folder / "plan.json", "--json"});
  const double took_s = used_s() - before_s;
  ASSERT_EQ(told.status, 0) << told.out << told.err;
  const auto found = nlohmann::json::parse(told.out).at("clearance");
  std::cout << found << ", " << took_s << " s\n";
  EXPECT_GT(found.at("on_meshes"), 200);
#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(took_s, 2.0);
#endif
}

TEST(PlanVerb, PredictsTheIntervalInEightyColumns) {
  const Scratch folder;
  std::vector<Change> one = {
      {"/features/0/characteristics",
       nlohmann::json::array(
           {{{"id", "CYLt least squares"}, {"form", "cylindricity"}, {"reference", "ls"}},
            {{"id", "size"}, {"form", "diameter"}, {"size", "GG"}}})}};
  write_plan_with_intervals(folder / "plan.json", one);
  const Outcome told = rondure({"plan", folder / "plan.json"});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, AllOf(HasSubstr("Predicted interval, before the first touch, 95 %"),
                              HasSubstr("at the sampled points"), HasSubstr("of the whole surface"),
                              HasSubstr("running surface, CYLt least squares"),
                              ContainsRegex("size\n +at the sampled points +[0-9.]+ mm +[0-9]"),
                              HasSubstr("Form of the parts: form_spectrum of the plan"),
                              Not(HasSubstr("the most that the qualification lets pass"))));
  EXPECT_LE(longest_line(told.out), 80U);
  one.push_back({"/uncertainty/probe", nlohmann::json::object()});
  write_plan_with_intervals(folder / "plan.json", one);
  const Outcome undeclared = rondure({"plan", folder / "plan.json"});
  EXPECT_THAT(undeclared.out, HasSubstr("the most that the qualification lets pass"));
  EXPECT_LE(longest_line(undeclared.out), 80U);
}

TEST(PlanVerb, SaysOfEveryExampleWhatIsPredictedOrWhyNot) {
  const auto told = [](const char* name) { return unbroken(rondure({"plan", example(name)}).out); };
  EXPECT_THAT(
      told("05_spindle_three_probe.json"),
      AllOf(HasSubstr("none; gains and angles of the probes are not declared"),
            HasSubstr("none; it is what differs from turn to turn, and only readings show")));
  EXPECT_THAT(told("07_crank_pin.json"),
              AllOf(HasSubstr("Predicted interval of analyses"),
                    HasSubstr("none; it is what differs from part to part")));
  EXPECT_THAT(told("03_calibrate_fixture.json"),
              AllOf(HasSubstr("before the first touch: none"),
                    HasSubstr("none; no influence is declared: state `uncertainty`")));
  EXPECT_THAT(told("04_part_in_two_poses.json"),
              AllOf(HasSubstr("Tool: ball 8 mm, shaft 3 x 150 mm"),
                    HasSubstr("of a cloud merged from several poses")));
  EXPECT_THAT(told("09_axle_points_file.json"), HasSubstr("its points come from a file"));
  EXPECT_THAT(told("14_bore_simulated.json"), HasSubstr("the plan declares no uncertainty"));
}

TEST(PlanVerb, PredictsAnalysesFromOneSimulatedSetOfData) {
  const Scratch folder;
  write(folder / "grain.json", wheel_with_a_grain().dump());  // its run-out is only a bound
  EXPECT_THAT(unbroken(rondure({"plan", folder / "grain.json"}).out),
              AllOf(HasSubstr("Predicted interval of analyses"),
                    HasSubstr("run-out: none; the simulated data give no value that proves")));
  const Outcome told = rondure({"plan", example("06_wheel.json")});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(unbroken(told.out),
              AllOf(HasSubstr("before the first reading, 95 %, um"), HasSubstr("wheel, run-out"),
                    HasSubstr("from edge-points"),
                    HasSubstr("One set of data, simulated with the seed 7 in place of 6")));
  EXPECT_LE(longest_line(told.out), 80U);
  const Outcome as_json = rondure({"plan", example("06_wheel.json"), "--json"});
  ASSERT_EQ(as_json.status, 0) << as_json.err;
  const auto document = nlohmann::json::parse(as_json.out);
  ASSERT_EQ(document["prediction"].size(), 3U);
  for (const auto& of : document["prediction"]) {
    SCOPED_TRACE(of["characteristic"]);
    EXPECT_EQ(of["from"], "one simulated set of data");
    EXPECT_EQ(of["simulated_seed"], 7);
    EXPECT_NEAR(of["below_um"].get<double>() + of["above_um"].get<double>(),
                2.0 * of["expanded_um"].get<double>(), 1e-9);
    double variance_um2 = 0.0;
    for (const auto& line : of["budget"]) {
      variance_um2 += std::pow(line["standard_uncertainty_um"].get<double>(), 2);
    }
    EXPECT_GT(variance_um2, 0.0);
    EXPECT_NEAR(of["linear_standard_uncertainty_um"].get<double>(), std::sqrt(variance_um2), 1e-9);
  }
}

TEST(PlanVerb, PredictsTheUncertaintyOfACalibration) {
  const Scratch folder;
  auto plan = nlohmann::json::parse(read(example("03_calibrate_fixture.json")));
  plan["features"][0]["rotary_axes"]["uncertainty"] = {{"ball_um", 0.1}, {"repeat_urad", 1}};
  write(folder / "plan.json", plan.dump());
  const Outcome told = rondure({"plan", folder / "plan.json"});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(unbroken(told.out),
              AllOf(HasSubstr("Predicted uncertainty of a calibration"), HasSubstr("u at most"),
                    HasSubstr("the most that the qualification lets pass"),
                    HasSubstr("The value itself cannot be foretold: it is what the axes do")));
  EXPECT_LE(longest_line(told.out), 80U);
  const Outcome as_json = rondure({"plan", folder / "plan.json", "--json"});
  ASSERT_EQ(as_json.status, 0) << as_json.err;
  const auto document = nlohmann::json::parse(as_json.out);
  ASSERT_EQ(document["prediction"].size(), 2U);
  for (const auto& of : document["prediction"]) {
    EXPECT_EQ(of["from"], "linear propagation");
    EXPECT_GT(of["linear_standard_uncertainty_um"].get<double>(), 0.0);
    EXPECT_GT(of["ball_centers"].get<int>(), 0);
  }
}

// The uncertainty of a residual is not that of an error of an axis.
TEST(PlanVerb, PredictsNoErrorOfAnAxis) {
  const Scratch folder;
  auto plan = nlohmann::json::parse(read(example("03_calibrate_fixture.json")));
  plan["features"][0]["rotary_axes"]["uncertainty"] = {{"ball_um", 0.1}, {"repeat_urad", 1}};
  for (const char* error : {"EX", "EB"}) {
    plan["features"][0]["characteristics"].push_back(
        {{"id", error}, {"form", "axis-error"}, {"axis", "alpha"}, {"error", error}});
  }
  write(folder / "plan.json", plan.dump());
  const Outcome told = rondure({"plan", folder / "plan.json"});
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(unbroken(told.out), HasSubstr("EX, EB: none; it is an error of the axis itself"));
  const Outcome as_json = rondure({"plan", folder / "plan.json", "--json"});
  ASSERT_EQ(as_json.status, 0) << as_json.err;
  const auto document = nlohmann::json::parse(as_json.out);
  ASSERT_EQ(document["prediction"].size(), 4U);
  for (const std::size_t c : {2U, 3U}) {
    EXPECT_TRUE(document["prediction"][c].contains("none"));
    EXPECT_FALSE(document["prediction"][c].contains("linear_standard_uncertainty_um"));
  }
}

TEST(PlanVerb, SaysThatNoSamplingOfAnAnalysisIsSearched) {
  const Outcome told = rondure({"plan", example("06_wheel.json"), "--target-U", "1um"});
  EXPECT_EQ(told.status, 2);
  EXPECT_THAT(unbroken(told.out),
              AllOf(HasSubstr("No feature is touched"),
                    HasSubstr("proposes samplings of touched surfaces only, and none for wheel.")));
  EXPECT_LE(longest_line(told.out), 80U);
  const Outcome as_json =
      rondure({"plan", example("06_wheel.json"), "--target-U", "1um", "--json"});
  const auto document = nlohmann::json::parse(as_json.out);
  EXPECT_EQ(document["target"]["not_searched"], nlohmann::json::array({"wheel"}));
}

TEST(PlanVerb, RefusesATargetThatIsNoLength) {
  for (const char* target :
       {"1", "um", "0um", "-1um", "nanum", "infum", "1 km", "1e-400um", "1um2", "one um"}) {
    SCOPED_TRACE(target);
    const Outcome told =
        rondure({"plan", example("01_spool_simulated.json"), std::string("--target-U=") + target});
    EXPECT_EQ(told.status, 2);
    EXPECT_EQ(told.out, "");
    EXPECT_THAT(told.err, AllOf(HasSubstr("--target-U"), HasSubstr("1um, 0.001mm or 1000nm")));
  }
  EXPECT_EQ(rondure({"plan", example("01_spool_simulated.json"), "--target-U="}).status, 2);
  const Outcome bare = rondure({"plan", example("01_spool_simulated.json"), "--target-U", "1"});
  EXPECT_THAT(bare.err, HasSubstr("\"1\" has no unit"));
}

/// Example 01 with a declared and real repeatability, few points, and one characteristic; trials of
/// the reference "ls" take a tenth of the time of "mz".
std::vector<Change> small_inspection(const char* reference) {
  return {{"/uncertainty/probe/repeatability_um", 1.0},
          {"/simulation/probe/repeatability_um", 1.0},
          {"/features/0/sampling/layers", 3},
          {"/features/0/sampling/points_per_layer", 6},
          {"/features/0/pose_search/repeats", 1},
          {"/features/0/characteristics",
           nlohmann::json::array(
               {{{"id", "CYLt"}, {"form", "cylindricity"}, {"reference", reference}}})}};
}

TEST(PlanVerb, ProposesASamplingWhoseRunMeetsTheTarget) {
  constexpr double kTarget_um = 0.8;
  const Scratch folder;
  std::vector<Change> changes = small_inspection("mz");
  write_plan_with_intervals(folder / "plan.json", changes);
  const Outcome told = rondure({"plan", folder / "plan.json", "--json", "--target-U", "800nm"});
  ASSERT_EQ(told.status, 0) << told.err;
  const auto document = nlohmann::json::parse(told.out);
  EXPECT_GT(document["prediction"][0]["sampled_points"]["nine_of_ten_expanded_um"], kTarget_um);
  const auto& target = document["target"]["features"][0];
  EXPECT_EQ(target["met"], true);
  for (const auto& candidate : target["candidates"]) {
    const bool small = candidate["nine_of_ten_expanded_um"] <= kTarget_um;
    EXPECT_EQ(candidate["meets"], small);
    if (small) {
      EXPECT_GE(candidate["time_s"], target["best"]["time_s"]);
    }
  }
  for (const auto& change : target["changes"]) {
    changes.push_back({change["pointer"], change["value"]});
  }
  write_plan_with_intervals(folder / "better.json", changes);
  const auto better =
      nlohmann::json::parse(rondure({"plan", folder / "better.json", "--json"}).out);
  const auto& foretold = better["prediction"][0]["sampled_points"];
  EXPECT_NEAR(foretold["nine_of_ten_expanded_um"], target["best"]["nine_of_ten_expanded_um"], 1e-9);
  EXPECT_NEAR(better["time_s"], target["best"]["time_s"], 1e-6);
  EXPECT_EQ(better["touches"], target["best"]["touches"]);
  const Outcome run = rondure({"run", folder / "better.json", "--out", folder / "run", "--quiet"});
  ASSERT_LE(run.status, 1) << run.err;
  const auto report = nlohmann::json::parse(read(folder.path() / "run" / "report.json"));
  const auto& found = report["features"][0]["characteristics"][0]["uncertainty"];
  EXPECT_LE(found["sampled_points"]["expanded_um"], kTarget_um);
}

TEST(PlanVerb, SaysWhatLimitsATargetThatNoSamplingMeets) {
  const Scratch folder;
  write_plan_with_intervals(folder / "plan.json", small_inspection("ls"));
  const Outcome told = rondure({"plan", folder / "plan.json", "--target-U", "1e-9um"});
  EXPECT_EQ(told.status, 2);
  EXPECT_THAT(told.out, AllOf(HasSubstr("No sampling that was tried meets 1e-09 um"),
                              HasSubstr("probe-lobing"), HasSubstr("(the plan)")));
  EXPECT_LE(longest_line(told.out), 80U);
  const Outcome merged =
      rondure({"plan", example("04_part_in_two_poses.json"), "--target-U", "1um"});
  EXPECT_EQ(merged.status, 2);
  EXPECT_THAT(merged.out, HasSubstr("of a cloud merged from several poses"));
  const Outcome file = rondure({"plan", example("09_axle_points_file.json"), "--target-U", "1um"});
  EXPECT_EQ(file.status, 2);
  EXPECT_THAT(file.out, HasSubstr("No feature is touched"));
}

}  // namespace
}  // namespace rondure::app::testing
