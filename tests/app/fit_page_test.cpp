// One command from a points file to a run with a page: it is a plan like any other, verifies and
// signs, and states the value that the fit prints.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A journal of 30 mm with three lobes of 1 um, as a German program exports it.
std::string export_of_a_journal() {
  std::string out = "Messpunkt;X-Ist [mm];Y-Ist [mm];Z-Ist [mm]\n";
  int number = 0;
  for (int layer = 0; layer < 5; ++layer) {
    for (int i = 0; i < 36; ++i) {
      const double angle = core::kTwoPi * i / 36;
      const double r = 15.0 + 0.001 * std::cos(3.0 * angle);
      std::string line = fmt::format("{};{:.6f};{:.6f};{:.6f}\n", ++number, r * std::cos(angle),
                                     r * std::sin(angle), 6.0 * layer);
      for (char& c : line) {
        if (c == '.') c = ',';
      }
      out += line;
    }
  }
  return out;
}

class FitToAPage : public ::testing::Test {
 protected:
  void SetUp() override { write(points_, export_of_a_journal()); }

  [[nodiscard]] static json cylindricity_of(const fs::path& run) {
    return json::parse(read(run / "report.json"))["features"][0]["characteristics"][0];
  }

  Scratch folder_;
  fs::path points_ = folder_ / "journal A.csv";
  fs::path run_ = folder_ / "run";
};

// A file of several features: the person has named one, and the others are named as left out.
TEST_F(FitToAPage, OfOneFeatureOfAFileNamesTheOthers) {
  const fs::path shaft = source_dir() / "tests/data/shaft_drawing/shaft.csv";
  const fs::path plan = folder_ / "plan.json";
  const Outcome outcome = rondure({"fit", "cylinder", shaft, "--feature", "A", "--tolerance-um",
                                   "20", "--out", run_, "--save-plan", plan});
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  const Outcome valid = rondure({"validate", plan});
  EXPECT_EQ(valid.status, 0) << valid.err;
  EXPECT_THAT(valid.out, HasSubstr("; left out: \"B\" ("));
  json strict = json::parse(read(plan));
  strict["features"][0]["source"].erase("others");
  write(plan, strict.dump());
  EXPECT_THAT(rondure({"validate", plan}).err,
              HasSubstr("has rows that no feature of the plan takes: \"B\""));
}

TEST_F(FitToAPage, PointsOfTheSurfaceHaveNoTip) {
  const fs::path plan = folder_ / "plan.json";
  ASSERT_EQ(
      rondure({"fit", "cylinder", points_, "--points", "surface", "--save-plan", plan}).status, 0);
  EXPECT_EQ(json::parse(read(plan))["features"][0]["source"]["points"], "surface");
  const Outcome both = rondure({"fit", "cylinder", points_, "--points", "surface", "--size", "GG",
                                "--tip-diameter-mm", "3"});
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("points of the surface have no tip"));
}

TEST_F(FitToAPage, APlanAloneTakesNoSerialNumber) {
  for (const char* option : {"--serial", "--operator"}) {
    const Outcome refused =
        rondure({"fit", "cylinder", points_, option, "0042", "--save-plan", folder_ / "plan.json"});
    EXPECT_NE(refused.status, 0);
    EXPECT_THAT(refused.err, HasSubstr(std::string(option) + " requires --out"));
  }
}

TEST_F(FitToAPage, IsARunThatVerifiesAndSigns) {
  const Outcome outcome = rondure(
      {"fit", "cylinder", points_, "--tolerance-um", "2.5", "--serial", "0042", "--out", run_});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("Read as "));
  EXPECT_THAT(outcome.out, HasSubstr((run_ / "report.html").string()));
  EXPECT_THAT(outcome.out, HasSubstr("\nArchived in "));
  const json asked = cylindricity_of(run_);
  EXPECT_EQ(asked["id"], "CYLt 2.5");
  EXPECT_EQ(asked["verdict"], "conforms");
  EXPECT_EQ(asked["tolerance_um"], 2.5);
  const json fitted = json::parse(rondure({"fit", "cylinder", points_, "--json"}).out);
  EXPECT_NEAR(asked["value_um"].get<double>(), 1e3 * fitted["mz"]["deviation_mm"].get<double>(),
              1e-9);
  EXPECT_EQ(json::parse(read(run_ / "report.json"))["header"]["serial"], "0042");
  EXPECT_EQ(rondure({"verify", run_}).status, 0);
  const std::string key = (folder_ / "key.pem").string();
  ASSERT_EQ(std::system(("openssl genpkey -algorithm ed25519 -out '" + key + "'").c_str()), 0);
  EXPECT_EQ(rondure({"sign", run_, "--key", key}).status, 0);
  EXPECT_EQ(rondure({"fit", "cylinder", points_, "--tolerance-um", "1.5", "--out", folder_ / "two"})
                .status,
            1)
      << "2 um do not hold 1.5";
}

TEST_F(FitToAPage, ItsPlanCanBeSavedEditedAndRunFromAnywhere) {
  const fs::path plan = folder_ / "plans" / "journal.json";
  fs::create_directory(plan.parent_path());
  const Outcome saved = rondure({"fit", "cylinder", fs::relative(points_), "--tolerance-um", "2.5",
                                 "--reference", "ls", "--inside", "--tip-diameter-mm", "3",
                                 "--columns", "2,3,4", "--layers", "heights", "--save-plan", plan});
  ASSERT_EQ(saved.status, 0) << saved.err;
  EXPECT_FALSE(fs::exists(run_));
  const json written = json::parse(read(plan));
  const json& feature = written["features"][0];
  EXPECT_EQ(feature["source"]["file"], "../journal A.csv");
  EXPECT_EQ(feature["side"], "inside");
  EXPECT_EQ(feature["source"]["tip_diameter_mm"], 3);
  EXPECT_EQ(feature["source"]["layers"], "heights");
  const Outcome valid = rondure({"validate", plan});
  EXPECT_THAT(valid.out, HasSubstr("feature cylinder: ../journal A.csv: "));
  EXPECT_THAT(valid.out, HasSubstr("180 points"));
  ASSERT_EQ(rondure({"run", plan, "--out", run_, "--quiet"}).status, 0);
  EXPECT_THAT(read(run_ / "report.html"), HasSubstr("180 points"));
  EXPECT_EQ(cylindricity_of(run_)["reference"], "LSCY");
  const Outcome again = rondure({"fit", "cylinder", points_, "--save-plan", plan});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("the file exists"));
}

TEST_F(FitToAPage, WithoutAToleranceIsReportedAndNotJudged) {
  ASSERT_EQ(rondure({"fit", "cylinder", points_, "--out", run_}).status, 0);
  EXPECT_EQ(cylindricity_of(run_)["verdict"], "not toleranced");
}

TEST_F(FitToAPage, WhatNoPageShowsIsRefusedBeforeAnythingIsWritten) {
  const auto refusal = [&](std::vector<std::string> more, const std::string& shape = "cylinder",
                           const std::string& file = {}) {
    std::vector<std::string> words = {"fit", shape, file.empty() ? points_.string() : file};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_FALSE(fs::exists(run_));
    return outcome.err;
  };
  EXPECT_THAT(refusal({"--out", run_}, "sphere"), HasSubstr("a page is of a circle"));
  EXPECT_THAT(refusal({"--out", run_, "--json"}), HasSubstr("report.json"));
  EXPECT_THAT(refusal({"--out", run_, "--size", "GG"}), HasSubstr("save the plan"));
  EXPECT_THAT(refusal({"--out", run_}, "cylinder", "-"), HasSubstr("standard input"));
  EXPECT_THAT(refusal({"--tolerance-um", "2"}), HasSubstr("--out"));
  EXPECT_THAT(refusal({"--tolerance-um", "-2", "--out", run_}), HasSubstr("--tolerance-um"));
  EXPECT_THAT(refusal({"--tolerance-um", "nan", "--out", run_}), HasSubstr("--tolerance-um"));
  write(points_, "x;y;z\n1,2;3\n");
  EXPECT_THAT(refusal({"--out", run_}), HasSubstr("journal A.csv:2"));
}

TEST_F(FitToAPage, APlanIsSavedOnlyOfAFileThatCanBeRead) {
  const fs::path plan = folder_ / "plan.json";
  const auto told = [&](const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> words = {"fit", "cylinder", file};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = rondure(words);
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_FALSE(fs::exists(plan));
    EXPECT_FALSE(fs::exists(run_));
    EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("/features/")));
    return outcome.err;
  };
  EXPECT_THAT(told(folder_ / "absent.csv", {"--save-plan", plan}), HasSubstr("absent.csv"));
  EXPECT_THAT(told(folder_ / "absent.csv", {"--out", run_}), HasSubstr("absent.csv"));
  EXPECT_THAT(told(points_, {"--columns", "2,3,9", "--save-plan", plan}), HasSubstr("journal A"));
  EXPECT_THAT(told(points_, {"--save-plan", ""}), HasSubstr("--save-plan: is empty; name a place"));
  EXPECT_THAT(told(points_, {"--out", ""}), HasSubstr("--out: is empty; name a place"));
  EXPECT_THAT(told(points_, {"--tip-diameter-mm", "4000", "--out", run_}),
              HasSubstr("--tip-diameter-mm: 4000 mm is outside the limits"));
  const fs::path latin = folder_ / "M\xfcnchen.csv";
  fs::copy(points_, latin);
  EXPECT_EQ(rondure({"fit", "cylinder", latin}).status, 0);
  for (const char* option : {"--save-plan", "--out"}) {
    EXPECT_THAT(told(latin, {option, option == std::string("--out") ? run_ : plan}),
                HasSubstr("contains the byte 0xFC, which is not UTF-8, so that no plan can name"));
  }
}

}  // namespace
}  // namespace rondure::app::testing
