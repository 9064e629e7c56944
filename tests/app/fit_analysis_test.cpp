// `rondure fit wheel|spindle|contour`: the numbers of the worked examples, and that the verb is a
// plan: keys, intervals, verdicts, page, refusals.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "fit/contour/crank_motion.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

std::string sample_of(const std::string& name) {
  return (source_dir() / "tests/data" / name).string();
}

/// The command with a `--set` before each of the settings.
Outcome fit_with(Words words, const Words& settings) {
  words.insert(words.begin(), "fit");
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return rondure(words);
}

/// The feature in the JSON of the command.
json feature_of(Words words, const Words& settings) {
  words.emplace_back("--json");
  const Outcome out = fit_with(std::move(words), settings);
  EXPECT_LE(out.status, 1) << out.err;
  return json::parse(out.out).at("features").at(0);
}

const Words kPin = {"crank_radius_mm=49", "wheel_radius_mm=299.88", "pin_radius_mm=24.56"};

Words and_pin(Words settings) {
  settings.insert(settings.end(), kPin.begin(), kPin.end());
  return settings;
}

std::string four_files(const std::string& kind) {
  std::string out;
  for (int i = 1; i <= 4; ++i) {
    out += (i > 1 ? "," : "") + sample_of(fmt::format("spec_contour/{}{}.csv", kind, i));
  }
  return out;
}

TEST(FitWheel, GivesTheNumbersOfTheWorkedExamples) {
  const json one =
      feature_of({"wheel", sample_of("spec_wheel/example1.csv")},
                 {"mode=indexed", "axis_x_mm=12.02", "axis_z_mm=-7", "center=as-published"})
          .at("wheel");
  EXPECT_NEAR(one["center_mm"][0], 12.000438, 1.1e-6);
  EXPECT_NEAR(one["center_mm"][1], -6.998759, 1.1e-6);
  EXPECT_NEAR(one["radius_mm"], 50.0, 1.1e-6);
  EXPECT_NEAR(one["runout"]["fim_at_least_um"], 35.393, 1.6e-3);
  EXPECT_EQ(one["quadruples"]["accepted"], 70);
  const json two =
      feature_of({"wheel", sample_of("spec_wheel/example2.csv")}, {"mode=indexed", "robust=on"})
          .at("wheel");
  EXPECT_NEAR(two["center_mm"][0], 0.500655, 1.1e-6);
  EXPECT_NEAR(two["radius_mm"], 75.012471, 1.1e-6);
  EXPECT_EQ(two["dropped"][0]["row"], 4);
}

TEST(FitWheel, MeasuresTheWheelButGivesNoPathThatGouges) {
  const auto path = [](const std::string& coefficients) {
    return feature_of(
               {"wheel", sample_of("spec_wheel/example1.csv")},
               {"mode=indexed", "surface.form=polynomial", "surface.coefficients=" + coefficients,
                "surface.from_mm=-20", "surface.to_mm=20", "surface.step_mm=1"})
        .at("wheel");
  };
  EXPECT_EQ(path("[0,0,0.0025]")["path"]["places"], 41);
  const json refused = path("[0,0,0.0125]");
  EXPECT_NEAR(refused["radius_mm"], 50.0, 1.1e-6);
  EXPECT_THAT(refused["path_refused"].dump(),
              HasSubstr("50 mm exceeds the concave radius of curvature 40 mm at x = 0 mm"));
}

TEST(FitSpindle, GivesThePlantedPart) {
  const std::string file = sample_of("spindle_dynamic/readings.csv");
  const json found = feature_of({"spindle", file}, and_pin({"layout=reference"})).at("spindle");
  EXPECT_EQ(found.at("mode"), "tracking");
  const std::map<int, double> planted = {{2, 3.0},  {3, 2.0},  {5, 0.8},  {7, 0.6},
                                         {11, 0.4}, {16, 0.5}, {23, 0.3}, {40, 0.2}};
  for (const json& h : found.at("harmonics")) {
    const auto at = planted.find(h.at("order"));
    EXPECT_NEAR(h.at("amplitude_um"), at == planted.end() ? 0.0 : at->second, 1e-4) << h;
  }
  const json a =
      feature_of({"spindle", file}, and_pin({"p1_to_p2_deg=52.3828125", "p2_to_p3_deg=248.90625"}));
  const json b = feature_of({"spindle", file},
                            and_pin({"p1_to_p2_deg=52.3828125", "p1_to_p3_deg=301.2890625"}));
  EXPECT_NEAR(a["spindle"]["layout"]["p2_to_p3_deg"], b["spindle"]["layout"]["p2_to_p3_deg"],
              1e-12);
  EXPECT_NEAR(a["spindle"]["part"]["mz"]["RONt_um"], b["spindle"]["part"]["mz"]["RONt_um"], 1e-9);
}

class FitContour : public ::testing::Test {
 protected:
  /// The first part with another trace of the axes.
  json with_axes(const std::string& file, Words settings) {
    settings.emplace_back("filter=done-by-gauge");
    return feature_of({"contour", "--axes", file, "--pin", sample_of("spec_contour/pin1.csv")},
                      settings)
        .at("contour");
  }
  /// Rows of the trace of part 1, each as `row` spells C and the errors of C and X.
  template <class Row>
  std::string trace_of(std::string text, const Row& row) {
    std::ifstream in(sample_of("spec_contour/axes1.csv"));
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      double c = 0.0;
      double c_error = 0.0;
      double x_error = 0.0;
      EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &c, &c_error, &x_error), 3);
      text += row(c, c_error, x_error) + "\n";
    }
    write(folder_ / "trace.csv", text);
    return (folder_ / "trace.csv").string();
  }
  Scratch folder_;
};

constexpr std::array kFollowing = {7.0430, 7.1535, 6.9326, 7.0872};

// The main journals of the worked example are its n.
TEST_F(FitContour, GivesTheNumbersOfTheWorkedExampleWithAndWithoutTraces) {
  const json found = feature_of({"contour", "--axes", four_files("axes"), "--pin",
                                 four_files("pin"), "--main", four_files("main")},
                                {"filter=done-by-gauge"})
                         .at("contour");
  const json without =
      feature_of({"contour", "--pin", four_files("pin"), "--main", four_files("main")},
                 {"filter=done-by-gauge"})
          .at("contour");
  EXPECT_EQ(without["separation"], "indirect");
  const double total[] = {8.9290, 8.5189, 6.4567, 6.2871};
  const double rest[] = {3.3301, 2.6908, 2.5161, 3.9805};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found["parts"][i]["total"]["pv_um"], total[i], 1e-4);
    EXPECT_NEAR(found["parts"][i]["following"]["pv_um"], kFollowing.at(i), 2e-4);
    EXPECT_NEAR(found["parts"][i]["rest"]["pv_um"], rest[i], 2e-4);
    EXPECT_GT(found["parts"][i]["indirect"]["correlation_with_direct"], 0.99999);
    EXPECT_NEAR(without["parts"][i]["following"]["pv_um"], kFollowing.at(i), 2e-3);
    EXPECT_TRUE(without["parts"][i]["axes"].is_null());
  }
  EXPECT_NEAR(found["stability"]["total"]["index"], 0.7772, 1e-4);
}

TEST_F(FitContour, ReadsOtherColumnsUnitsSignsAndPositions) {
  // As a control writes it: following errors in um and mdeg.
  const std::string control =
      trace_of("C,C_FOLLOW,X_FOLLOW\n", [](double c, double c_error, double x_error) {
        return fmt::format("{},{},{}", c, -1e3 * c_error, -1e3 * x_error);
      });
  const json named = with_axes(control, {R"(columns=[{"quantity":"c","in_file":"C"},
        {"quantity":"c_error","in_file":"C_FOLLOW","unit":"mdeg"},
        {"quantity":"x_error","in_file":"X_FOLLOW","unit":"um"}])",
                                         "error=command-minus-actual"});
  EXPECT_NEAR(named["parts"][0]["following"]["pv_um"], kFollowing[0], 2e-4);
  const std::string positions =
      trace_of("alpha_cmd_deg,d_cmd_mm,alpha_act_deg,d_act_mm\n",
               [](double c, double c_error, double x_error) {
                 const double x = fit::wheel_position_mm({}, c * core::kDegree);
                 return fmt::format("{},{:.6f},{:.6f},{:.6f}", c, x, c + c_error, x + x_error);
               });
  const json moved = with_axes(positions, {});
  EXPECT_NEAR(moved["parts"][0]["following"]["pv_um"], kFollowing[0], 5e-3);  // 6 decimals of a mm
  EXPECT_EQ(moved["parts"][0]["axes"]["stroke_checked"], true);
}

/// A wheel with what is asked of it.
Words asked_wheel(const Words& more) {
  Words words = {"fit",
                 "wheel",
                 sample_of("spec_wheel/example1.csv"),
                 "--set",
                 "mode=indexed",
                 "--set",
                 "axis_x_mm=12.02",
                 "--set",
                 "axis_z_mm=-7"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(FitAnalysis, StatesTheIntervalOfWhatIsDeclaredAndJudges) {
  const Outcome out = rondure(asked_wheel({"--set", "uncertainty.point_um=0.4", "--set",
                                           "uncertainty.axis_um=0.5", "--ask", "run-out=20"}));
  EXPECT_EQ(out.status, 1) << out.err;
  EXPECT_THAT(out.out, HasSubstr("run-out of wheel is"));
  EXPECT_THAT(out.out, HasSubstr("corrected"));
  for (std::size_t start = 0; start < out.out.size();) {
    const std::size_t end = out.out.find('\n', start);
    std::size_t columns = 0;
    for (std::size_t i = start; i < end; ++i) columns += (out.out[i] & 0xC0) != 0x80 ? 1 : 0;
    EXPECT_LE(columns, 80U) << out.out.substr(start, end - start);
    start = end + 1;
  }
  const Outcome bare = rondure(asked_wheel({}));
  EXPECT_EQ(bare.status, 0) << bare.err;
  EXPECT_THAT(bare.out, HasSubstr("no interval"));
}

TEST(FitAnalysis, IsTheRunOfThePlanThatItSaves) {
  const Scratch folder;
  const std::string plan = (folder / "sub" / "plan.json").string();
  fs::create_directory(folder / "sub");
  const Words asked = {"--set", "uncertainty.point_um=0.4",
                       "--set", "/decision_rule/rule=iso-14253-1",
                       "--ask", "roundness=50"};
  Words words = asked_wheel(asked);
  words.insert(words.end(), {"--out", (folder / "run").string(), "--save-plan", plan});
  const Outcome out = rondure(words);
  ASSERT_LE(out.status, 1) << out.err;
  EXPECT_EQ(rondure({"verify", (folder / "run").string()}).status, 0);
  EXPECT_TRUE(fs::exists(folder / "run" / "report.html"));
  Words again = asked_wheel(asked);
  again.emplace_back("--json");
  const json report = json::parse(read(folder / "run" / "report.json"));
  EXPECT_EQ(json::parse(rondure(again).out)["features"], report["features"]);
  EXPECT_TRUE(report["features"][0]["characteristics"][0].contains("uncertainty"));
  EXPECT_EQ(
      rondure({"run", plan, "--out", (folder / "second").string(), "--archive", "none"}).status,
      out.status);
  EXPECT_EQ(json::parse(read(folder / "second" / "report.json"))["features"], report["features"]);
}

TEST(FitAnalysis, LeavesNothingBehind) {
  const Scratch folder;
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before != nullptr ? before : "";
  ::setenv("TMPDIR", folder.path().c_str(), 1);
  EXPECT_EQ(rondure(asked_wheel({})).status, 0);
  EXPECT_EQ(rondure(asked_wheel({"--set", "mode=asleep"})).status, 2);
  EXPECT_TRUE(fs::is_empty(folder.path()));
  before != nullptr ? ::setenv("TMPDIR", kept.c_str(), 1) : ::unsetenv("TMPDIR");
}

TEST(FitAnalysis, SaysWhereNoFolderCanBeMade) {
  const Scratch folder;
  const std::string said = (folder / "said.txt").string();
  const std::string command =
      fmt::format("TMPDIR=/proc {} fit wheel '{}' --set mode=indexed 2> '{}'", RONDURE_BINARY,
                  sample_of("spec_wheel/example1.csv"), said);
  EXPECT_EQ(std::system(command.c_str()) >> 8, 2);
  EXPECT_THAT(read(said), HasSubstr("set TMPDIR"));
}

TEST(FitAnalysis, NamesWhatIsWrongWithTheInput) {
  const Scratch folder;
  const auto refused = [](const Words& words) {
    const Outcome out = rondure(words);
    EXPECT_EQ(out.status, 2) << out.out;
    EXPECT_EQ(out.out, "");
    return out.err;
  };
  const auto wheel_of = [&](const std::string& text) {
    write(folder / "w.csv", text);
    return refused({"fit", "wheel", (folder / "w.csv").string(), "--set", "mode=indexed"});
  };
  EXPECT_THAT(wheel_of("x,z\n1,2\nnan,4\n"),
              HasSubstr("/w.csv:3: x is \"nan\"; a finite number is expected"));
  EXPECT_THAT(wheel_of("x,q\n1,2\n"), HasSubstr("w.csv:1: column"));
  EXPECT_THAT(refused({"fit", "wheel", (folder / "none.csv").string(), "--set", "mode=indexed"}),
              HasSubstr("none.csv"));
  EXPECT_THAT(refused({"fit", "wheel", sample_of("spec_wheel/example1.csv")}),
              HasSubstr("--set mode"));
  EXPECT_THAT(refused(asked_wheel({"--set", "nominal_radius_mm=5000"})),
              HasSubstr("--set nominal_radius_mm"));
  EXPECT_THAT(refused(asked_wheel({"--set", "colour=red"})), HasSubstr("--set colour"));
  EXPECT_THAT(refused(asked_wheel({"--set", "mode"})), HasSubstr("KEY=VALUE is expected"));
  EXPECT_THAT(refused(asked_wheel({"--set", "mode.x=1"})), HasSubstr("no such place"));
  EXPECT_THAT(refused(asked_wheel({"--set", "/features=3"})), HasSubstr("--set /features"));
  EXPECT_THAT(refused(asked_wheel({"--set", "/features/0=3"})), HasSubstr("--set /features/0"));
  EXPECT_THAT(refused(asked_wheel({"--set", "/a~2=3"})), HasSubstr("no such place"));
  EXPECT_THAT(refused(asked_wheel({"--set", "program.note=\xFF"})), HasSubstr("not UTF-8"));
  EXPECT_THAT(refused(asked_wheel({"--ask", "run-out=much"})), HasSubstr("FORM=LIMIT"));
  EXPECT_THAT(refused(asked_wheel({"--ask", "beauty"})), HasSubstr("--ask"));
  EXPECT_THAT(refused(asked_wheel({"--json", "--out", (folder / "r").string()})),
              HasSubstr("--json"));
  EXPECT_THAT(refused({"fit", "contour", "--axes", four_files("axes"), "--pin",
                       sample_of("spec_contour/pin1.csv")}),
              HasSubstr("4 files for --axes, 1 pins"));
  EXPECT_THAT(refused({"fit", "contour", "--pin", sample_of("spec_contour/pin1.csv")}),
              HasSubstr("main"));
  Words save = asked_wheel({"--set", "mode=asleep"});
  save.insert(save.end(), {"--save-plan", (folder / "plan.json").string()});
  EXPECT_THAT(refused(save), HasSubstr("--set mode"));
  EXPECT_FALSE(fs::exists(folder / "plan.json"));
}

}  // namespace
}  // namespace rondure::app::testing
