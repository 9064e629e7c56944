// `rondure fit roundness`, as a shell sees it.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace rondure::app {
namespace {

using ::testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string text;  ///< Both streams.
};

/// @param arguments  Words between blanks, or in quotes.
Outcome rondure(const std::string& arguments) {
  std::istringstream stream(arguments);
  std::vector<std::string> words;
  for (std::string word; stream >> std::quoted(word);) words.push_back(word);
  const testing::Outcome out = testing::rondure(words);
  return {out.status, out.err + out.out};
}

const std::string kProfile =
    std::string(RONDURE_SOURCE_DIR) + "/tests/data/spec_roundness/profile.csv";

class RoundnessVerb : public ::testing::Test {
 protected:
  std::string file(const std::string& text) {
    const auto path = folder_ / "part.csv";
    std::ofstream(path) << text;
    return '"' + path.string() + '"';
  }
  /// 360 rows of a two-lobed profile, each given to `row(degrees, um)`.
  std::string profile(const std::function<std::string(int, double)>& row) {
    std::string text = "theta_deg,r_um\n";
    for (int i = 0; i < 360; ++i) {
      text += row(i, 3.0 * std::cos(2.0 * i * std::numbers::pi / 180.0));
    }
    return file(text);
  }
  static std::string plain(double degrees, double um) {
    return std::to_string(degrees) + "," + std::to_string(um) + "\n";
  }

  test::Scratch folder_;
};

TEST_F(RoundnessVerb, GivesTheNumbersOfTheWorkedExampleAsJson) {
  const auto out = rondure("fit roundness " + kProfile + " --json");
  ASSERT_EQ(out.status, 0) << out.text;
  const auto json = nlohmann::json::parse(out.text);
  EXPECT_NEAR(json["ls"]["RONt_um"], 12.507570, 1e-6);
  EXPECT_NEAR(json["ls"]["RONq_um"], 2.684543, 1e-6);
  EXPECT_NEAR(json["mz"]["RONt_um"], 10.664776, 1e-6);
  EXPECT_EQ(json["mz"]["certificate"]["kind"], "global");
  EXPECT_EQ(json["filter"]["cutoff_upr"], 50.0);
  EXPECT_EQ(json["filter"]["sampling_overridden"], false);
  EXPECT_NEAR(json["harmonics"][15]["amplitude_um"], 0.5, 1e-9);
  EXPECT_TRUE(json["warnings"].empty());
}

TEST_F(RoundnessVerb, RefusesACutOffTooHighAndRecordsWhenItIsOverridden) {
  const auto refused = rondure("fit roundness " + kProfile + " --cutoff-upr 500");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.text, HasSubstr("2.05 per undulation at 500 UPR, at least 7 are needed"));
  const auto taken =
      rondure("fit roundness " + kProfile + " --cutoff-upr 500 --override-sampling --json");
  ASSERT_EQ(taken.status, 0) << taken.text;
  const auto json = nlohmann::json::parse(taken.text);
  EXPECT_NEAR(json["ls"]["RONt_um"], 13.285998, 1e-6);
  EXPECT_EQ(json["filter"]["sampling_overridden"], true);
  EXPECT_EQ(json["warnings"][0]["code"], "undersampled");
}

TEST_F(RoundnessVerb, TakesEveryFilterAndPass) {
  for (const std::string filter : {"gaussian", "2rc", "robust", "spline", "none"}) {
    for (const std::string pass : {"low", "high", "band --cutoff-upr 15,100"}) {
      const auto out =
          rondure("fit roundness " + kProfile + " --filter " + filter + " --pass " + pass);
      // Without a filter every undulation stays: there is nothing that a high pass could mean.
      EXPECT_EQ(out.status, filter == "none" && pass != "low" ? 2 : 0) << out.text;
    }
  }
}

TEST_F(RoundnessVerb, AsksForTwoCutOffsInABandOnly) {
  EXPECT_THAT(rondure("fit roundness " + kProfile + " --pass band").text, HasSubstr("15,150"));
  EXPECT_EQ(rondure("fit roundness " + kProfile + " --cutoff-upr 15,50").status, 2);
  EXPECT_EQ(rondure("fit roundness " + kProfile + " --cutoff-upr 0").status, 2);
}

TEST_F(RoundnessVerb, EvaluatesPointsToo) {
  std::string text = "x,y\n";
  for (int i = 0; i < 720; ++i) {
    const double theta = i * std::numbers::pi / 360.0;
    const double r = 25.0 + 2e-3 * std::cos(3.0 * theta);
    text += std::to_string(100.0 + r * std::cos(theta)) + "," +
            std::to_string(r * std::sin(theta)) + "\n";
  }
  const auto out = rondure("fit roundness " + file(text) + " --cutoff-upr 15 --json");
  ASSERT_EQ(out.status, 0) << out.text;
  const auto json = nlohmann::json::parse(out.text);
  EXPECT_NEAR(json["ls"]["RONt_um"], 4.0 * std::exp2(-0.04), 0.01);  // six decimals of a mm
  EXPECT_NEAR(json["ls"]["center_mm"][0], 100.0, 1e-6);
}

TEST_F(RoundnessVerb, TakesColumnsAndUnitOfASection) {
  std::string text = "Punkt;E;N\n";
  for (int i = 0; i < 120; ++i) {
    const double theta = 3.0 * i * std::numbers::pi / 180.0;
    const double r = (20.0 + 3e-3 * std::cos(2.0 * theta)) / 25.4;
    text += fmt::format("{};{:.9f};{:.9f}\n", i + 1, r * std::cos(theta), r * std::sin(theta));
  }
  const std::string name = file(text);
  EXPECT_THAT(rondure("fit roundness " + name).text, HasSubstr("--columns"));
  const Outcome out = rondure("fit roundness " + name +
                              " --columns E,N --unit inch --filter none --reference ls --json");
  ASSERT_EQ(out.status, 0) << out.text;
  const auto value = nlohmann::json::parse(out.text).at("ls");
  EXPECT_NEAR(value.at("RONt_um"), 6.0, 1e-3);
  EXPECT_NEAR(value.at("radius_mm"), 20.0, 1e-4);
  const Outcome polar = rondure("fit roundness " + kProfile + " --unit inch");
  EXPECT_EQ(polar.status, 2);
  EXPECT_THAT(polar.text, HasSubstr("--unit is that of x and y"));
}

TEST_F(RoundnessVerb, NamesTheLineOfWhatIsNotANumber) {
  const auto out = rondure("fit roundness " + profile([](int i, double um) {
                             return i == 7 ? std::string("7,nan\n") : plain(i, um);
                           }));
  EXPECT_EQ(out.status, 2);
  EXPECT_THAT(out.text, HasSubstr("part.csv:9: r_um is \"nan\""));
}

TEST_F(RoundnessVerb, RefusesMissingAnglesAndArcs) {
  const auto gap = rondure("fit roundness --cutoff-upr 15 " + profile([](int i, double um) {
                             return i > 90 && i < 100 ? std::string() : plain(i, um);
                           }));
  EXPECT_EQ(gap.status, 2);
  EXPECT_THAT(gap.text, HasSubstr("the largest gap between angles is 10 deg"));
  const auto arc = rondure("fit roundness --filter none " + profile([](int i, double um) {
                             return i < 10 ? plain(i, um) : std::string();
                           }));
  EXPECT_EQ(arc.status, 2);
  EXPECT_THAT(arc.text, HasSubstr("cover 9.00 deg"));
}

TEST_F(RoundnessVerb, WarnsOfAnglesOutOfOrder) {
  const auto out = rondure("fit roundness --cutoff-upr 15 " + profile([](int i, double um) {
                             return i == 100 ? plain(i, um) + plain(i - 1.5, um) : plain(i, um);
                           }));
  EXPECT_EQ(out.status, 0);
  EXPECT_THAT(out.text, HasSubstr("[angle-order]"));
}

TEST_F(RoundnessVerb, SuspectsMillimetresAndRadians) {
  const auto mm = rondure("fit roundness --cutoff-upr 15 " +
                          profile([](int i, double um) { return plain(i, um * 1e-3); }));
  EXPECT_EQ(mm.status, 0);
  EXPECT_THAT(mm.text, HasSubstr("is r in mm? Then it is 5."));
  const auto radians = rondure("fit roundness --cutoff-upr 15 " + profile([](int i, double um) {
                                 return plain(i * std::numbers::pi / 180.0, um);
                               }));
  EXPECT_EQ(radians.status, 2);
  EXPECT_THAT(radians.text, HasSubstr("one turn in radians"));
}

TEST_F(RoundnessVerb, GivesTheReferencesThatAreAskedFor) {
  const auto all = nlohmann::json::parse(rondure("fit roundness " + kProfile + " --json").text);
  for (const char* name : {"ls", "mz", "mc", "mi"}) {
    SCOPED_TRACE(name);
    const auto out = rondure("fit roundness " + kProfile + " --json --reference " + name);
    ASSERT_EQ(out.status, 0) << out.text;
    const auto json = nlohmann::json::parse(out.text);
    EXPECT_EQ(json[name], all[name]);
    for (const char* other : {"ls", "mz", "mc", "mi"}) {
      EXPECT_EQ(json.contains(other), std::string(name) == other);
    }
    EXPECT_GE(json[name]["RONt_um"], all["mz"]["RONt_um"]);
  }
  EXPECT_TRUE(all["mc"]["contacts_deg"].contains("outer"));
  EXPECT_FALSE(all["mc"]["contacts_deg"].contains("inner"));
  EXPECT_LT(all["mi"]["radius_mm"], all["ls"]["radius_mm"]);
  EXPECT_LT(all["ls"]["radius_mm"], all["mc"]["radius_mm"]);
  EXPECT_EQ(rondure("fit roundness " + kProfile + " --reference mq").status, 2);
}

TEST_F(RoundnessVerb, AReferenceThatDoesNotExistIsNullWithAWarning) {
  const auto out = rondure("fit roundness --filter none --json " + profile([](int i, double um) {
                             return i <= 150 ? plain(i, um) : std::string();
                           }));
  ASSERT_EQ(out.status, 0) << out.text;
  const auto json = nlohmann::json::parse(out.text);
  EXPECT_TRUE(json["mc"].is_null() && json["mi"].is_null());
  EXPECT_TRUE(json["mz"].is_object());
  EXPECT_EQ(json["warnings"].back()["code"], "reference-absent");
}

TEST_F(RoundnessVerb, RefusesTooFewPointsAndMissingFiles) {
  EXPECT_THAT(
      rondure("fit roundness --filter none " + file("theta_deg,r_um\n0,1\n90,2\n180,1\n")).text,
      HasSubstr("3 different angles; a profile needs at least 4"));
  EXPECT_EQ(rondure("fit roundness nowhere.csv").status, 2);
  EXPECT_EQ(rondure("fit roundness").status, 2);
  EXPECT_EQ(rondure("fit").status, 2);
}

}  // namespace
}  // namespace rondure::app
