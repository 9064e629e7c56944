// `rondure fit contour`, as a shell sees it.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
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

using ::testing::HasSubstr;

std::string four_files(const std::string& kind) {
  std::string out;
  for (int i = 1; i <= 4; ++i) {
    out +=
        (i > 1 ? "," : "") +
        (source_dir() / "tests/data/spec_contour" / (kind + std::to_string(i) + ".csv")).string();
  }
  return out;
}

std::string one(const std::string& kind) {
  return (source_dir() / "tests/data/spec_contour" / (kind + "1.csv")).string();
}

/// The command for all four parts, with more arguments.
Outcome four_parts(std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"fit",   "contour",         "--axes",       four_files("axes"),
                                    "--pin", four_files("pin"), "--prefiltered"};
  words.insert(words.end(), more.begin(), more.end());
  return rondure(words);
}

class ContourVerb : public ::testing::Test {
 protected:
  /// The axes of part 1 with one text in place of another, at its first place.
  std::string axes_with(const std::string& from, const std::string& to) {
    const auto file = folder_ / "axes.csv";
    write(file, read(one("axes")));
    replace_in(file, from, to);
    return file.string();
  }
  Outcome with_axes(const std::string& file, std::vector<std::string> more = {}) {
    std::vector<std::string> words = {"fit",   "contour",  "--axes",       file,
                                      "--pin", one("pin"), "--prefiltered"};
    words.insert(words.end(), more.begin(), more.end());
    return rondure(words);
  }
  TemporaryFolder folder_;
};

// The main journals of the worked example are its n.
TEST_F(ContourVerb, WithoutTracesTakesTheMainJournal) {
  const auto out = rondure({"fit", "contour", "--pin", four_files("pin"), "--main",
                            four_files("main"), "--prefiltered", "--json"});
  ASSERT_EQ(out.status, 0) << out.err;
  const auto document = nlohmann::json::parse(out.out);
  EXPECT_EQ(document["separation"], "indirect");
  EXPECT_TRUE(document["diagnosis"].is_null());
  const double following[] = {7.0430, 7.1535, 6.9326, 7.0872};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(document["parts"][i]["following"]["pv_um"], following[i], 2e-3);
    EXPECT_TRUE(document["parts"][i]["axes"].is_null());
  }
  const auto alone = rondure({"fit", "contour", "--pin", one("pin")});
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, ::testing::HasSubstr("--main may be left out, or --axes, not both"));
}

TEST_F(ContourVerb, GivesTheNumbersOfTheWorkedExampleAsJson) {
  const auto out = four_parts({"--json", "--main", four_files("main")});
  ASSERT_EQ(out.status, 0) << out.err;
  const auto document = nlohmann::json::parse(out.out);
  const double total[] = {8.9290, 8.5189, 6.4567, 6.2871};
  const double following[] = {7.0430, 7.1535, 6.9326, 7.0872};
  const double rest[] = {3.3301, 2.6908, 2.5161, 3.9805};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(document["parts"][i]["total"]["pv_um"], total[i], 1e-4);
    EXPECT_NEAR(document["parts"][i]["following"]["pv_um"], following[i], 2e-4);
    EXPECT_NEAR(document["parts"][i]["rest"]["pv_um"], rest[i], 2e-4);
    EXPECT_GT(document["parts"][i]["indirect"]["correlation_with_direct"], 0.99999);
  }
  EXPECT_NEAR(document["stability"]["total"]["index"], 0.7772, 1e-4);
  EXPECT_EQ(document["stability"]["following"]["word"], "stable");
  EXPECT_EQ(document["stability"]["rest"]["word"], "unstable");
  EXPECT_TRUE(document["warnings"].empty()) << document["warnings"];
}

TEST_F(ContourVerb, SaysForAPersonWhatToDo) {
  const auto out = four_parts();
  ASSERT_EQ(out.status, 0) << out.err;
  EXPECT_THAT(out.out, HasSubstr("part pin3\n"));
  EXPECT_THAT(out.out, HasSubstr("compensate it in X"));
  EXPECT_THAT(out.out, HasSubstr("look for a mechanical cause"));
}

TEST_F(ContourVerb, ReadsOtherColumnsUnitsAndSigns) {
  // The same trace as a control writes it: following errors in um and mdeg, another column between.
  std::ifstream in(one("axes"));
  std::string line;
  std::string text = "t_ms,C,C_FOLLOW,X_FOLLOW\n";
  std::getline(in, line);
  for (int i = 0; std::getline(in, line); ++i) {
    const auto a = line.find(',');
    const auto b = line.find(',', a + 1);
    text += std::to_string(4 * i) + "," + line.substr(0, a) + "," +
            std::to_string(-1e3 * std::stod(line.substr(a + 1, b - a - 1))) + "," +
            std::to_string(-1e3 * std::stod(line.substr(b + 1))) + "\n";
  }
  write(folder_ / "control.csv", text);
  write(folder_ / "map.json",
        R"({"columns": {"c": {"column": "C"},
            "c_error": {"column": "C_FOLLOW", "unit": "mdeg", "sign": -1},
            "x_error": {"column": "X_FOLLOW", "unit": "um", "sign": -1}}})");
  const std::string file = (folder_ / "control.csv").string();
  const auto by_file = with_axes(file, {"--json", "--mapping", (folder_ / "map.json").string()});
  ASSERT_EQ(by_file.status, 0) << by_file.err;
  const auto by_words =
      with_axes(file, {"--json", "--error-sign", "-1", "--column", "c=C", "--column",
                       "c_error=C_FOLLOW:mdeg", "--column", "x_error=X_FOLLOW:um"});
  ASSERT_EQ(by_words.status, 0) << by_words.err;
  const auto document = nlohmann::json::parse(by_file.out);
  EXPECT_NEAR(document["parts"][0]["following"]["pv_um"], 7.0430, 2e-4);
  EXPECT_EQ(document["parts"], nlohmann::json::parse(by_words.out)["parts"]);
  // A column of the main journal alone.
  write(folder_ / "main.csv", read(one("main")));
  replace_in(folder_ / "main.csv", "deviation_um", "MAIN");
  const auto by_main = with_axes(one("axes"), {"--json", "--main", (folder_ / "main.csv").string(),
                                               "--column", "main_deviation=MAIN"});
  EXPECT_EQ(by_main.status, 0) << by_main.err;
}

TEST_F(ContourVerb, TakesPositionsInPlaceOfErrors) {
  std::ifstream in(one("axes"));
  std::string line;
  std::string text = "alpha_cmd_deg,d_cmd_mm,alpha_act_deg,d_act_mm\n";
  std::getline(in, line);
  while (std::getline(in, line)) {
    const auto a = line.find(',');
    const auto b = line.find(',', a + 1);
    const double c = std::stod(line.substr(0, a));
    const double x = fit::wheel_position_mm({}, c * core::kDegree);
    text += fmt::format("{},{:.6f},{:.6f},{:.6f}\n", line.substr(0, a), x,
                        c + std::stod(line.substr(a + 1, b - a - 1)),
                        x + std::stod(line.substr(b + 1)));
  }
  write(folder_ / "positions.csv", text);
  const auto out =
      with_axes((folder_ / "positions.csv").string(), {"--json", "--error-sign", "-1"});
  ASSERT_EQ(out.status, 0) << out.err;
  const auto document = nlohmann::json::parse(out.out);
  EXPECT_NEAR(document["parts"][0]["following"]["pv_um"], 7.0430, 5e-3);  // six decimals of a mm
  EXPECT_EQ(document["settings"]["error_sign"], 1);
  EXPECT_EQ(document["parts"][0]["axes"]["stroke_checked"], true);
  const auto other = with_axes((folder_ / "positions.csv").string(), {"--crank-radius-mm", "45"});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("They fit a crank radius of 49.000 mm (stated 45)"));
  EXPECT_THAT(with_axes(one("axes")).out, HasSubstr("stroke-unchecked"));
}

TEST_F(ContourVerb, WritesTheCurves) {
  const std::string file = (folder_ / "curves.csv").string();
  ASSERT_EQ(four_parts({"--curves", file}).status, 0);
  const std::string text = read(file);
  EXPECT_THAT(text, ::testing::StartsWith("beta_deg,t1_um,f1_um,n1_um,t2_um,"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1441);
}

TEST_F(ContourVerb, NamesFileAndRowOfBadNumbersAndAngles) {
  const auto nan = with_axes(axes_with("\n3.6,0.00", "\n3.6,nan,0\n3.7,0.00"));
  EXPECT_EQ(nan.status, 2);
  EXPECT_THAT(nan.err, HasSubstr("axes.csv:5:"));
  const auto back = with_axes(axes_with("\n60,", "\n58,"));
  EXPECT_EQ(back.status, 2);
  EXPECT_THAT(back.err, HasSubstr("row 50,"));
  EXPECT_THAT(back.err, HasSubstr("[angle-order]"));
}

TEST_F(ContourVerb, RefusesWhatCannotBe) {
  EXPECT_THAT(four_parts({"--crank-radius-mm", "400"}).err, HasSubstr("400 mm"));
  EXPECT_THAT(rondure({"fit", "contour", "--axes", four_files("axes"), "--pin", one("pin")}).err,
              HasSubstr("4 files for --axes, 1 for --pin"));
  EXPECT_THAT(four_parts({"--column", "speed=V"}).err, HasSubstr("there is no quantity \"speed\""));
  EXPECT_THAT(four_parts({"--column", "c_error=C:um"}).err,
              HasSubstr("one of lengths; it takes deg"));
  EXPECT_THAT(four_parts({"--column", "c=NIX"}).err, HasSubstr("the file needs the columns NIX"));
  EXPECT_EQ(four_parts({"--cutoff-upr", "400"}).status, 2);
}

TEST_F(ContourVerb, WarnsWithEvidence) {
  EXPECT_THAT(four_parts({"--error-sign", "-1"}).out, HasSubstr("error_sign 1 rather than -1?"));
  const auto filtered = rondure({"fit", "contour", "--axes", one("axes"), "--pin", one("pin")});
  EXPECT_THAT(filtered.out, HasSubstr("the gauge seems to have filtered already"));
  const auto turned = four_parts({"--phase-offset-deg", "6"});
  EXPECT_THAT(turned.out, HasSubstr("[alignment]"));
}

TEST(ContourFeature, FindsTheHiddenRestOfEverySimulatedPin) {
  const TemporaryFolder folder;
  // The seed of the plan, and another one.
  const auto other = rondure({"run", example("07_crank_pin.json"), "--out", folder / "run",
                              "--format", "json", "--archive", "none", "--seed", "8"});
  ASSERT_LE(other.status, 1) << other.err;
  for (const auto& run : {example_runs() / "07_crank_pin", folder / "run"}) {
    SCOPED_TRACE(run);
    const auto report = nlohmann::json::parse(read(run / "report.json"));
    const auto& feature = report["features"][0];
    for (const auto& warning : feature["warnings"]) EXPECT_EQ(warning["code"], "alignment");
    EXPECT_EQ(feature["contour"]["stability"]["following"]["word"], "stable");
    const auto journal = journal_of(run);
    for (int part = 0; part < 4; ++part) {
      const auto* truth = journal.truth_series_of(0, fmt::format("truth {}", part + 1));
      ASSERT_NE(truth, nullptr);
      const auto hidden = truth->column("rest_um").value();
      const auto& found = feature["contour"]["curves"][static_cast<std::size_t>(part)]["rest_um"];
      ASSERT_EQ(found.size(), hidden.size());
      double squares = 0.0;
      for (std::size_t m = 0; m < hidden.size(); ++m) {
        squares += std::pow(found[m].get<double>() - hidden[m], 2);
      }
      // Roughness 0.1 um behind 50 UPR leaves 0.03 um, the noise of the traces about as much.
      EXPECT_LT(std::sqrt(squares / static_cast<double>(hidden.size())), 0.1);
    }
  }
}

}  // namespace
}  // namespace rondure::app::testing
