#include <algorithm>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/files.h"
#include "tests/app/program.h"

namespace rondure::app::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::size_t longest_line(const std::string& text) {
  std::size_t out = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out = std::max(out, line.size());
  return out;
}

TEST(PlanVerb, TellsStagesTimeAndPathInEightyColumns) {
  const Outcome told = rondure({"plan", example("01_spool_simulated.json")});
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
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json["touches"], 13 + 6 + 3 * 45);
  ASSERT_EQ(json["stages"].size(), 3U);
  EXPECT_EQ(json["stages"][2]["final"], true);
  double time_s = 0.0;
  for (const auto& stage : json["stages"]) time_s += stage["time_s"].get<double>();
  EXPECT_NEAR(json["time_s"].get<double>(), time_s, 1e-9);
}

TEST(PlanVerb, DrawsAPicture) {
  const TemporaryFolder folder;
  const Outcome told =
      rondure({"plan", example("01_spool_simulated.json"), "--svg", folder / "way.svg"});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(read(folder / "way.svg"),
              AllOf(StartsWith("<svg "), HasSubstr("From the side"), HasSubstr("</svg>")));
  const Outcome absent = rondure(
      {"plan", example("01_spool_simulated.json"), "--svg", folder / "x.svg", "--feature", "bore"});
  EXPECT_EQ(absent.status, 2);
  EXPECT_THAT(absent.err, HasSubstr("no touched feature has the id bore"));
}

TEST(PlanVerb, NamesWhatIsOutOfReachAndMovesNothing) {
  const TemporaryFolder folder;
  write_plan(folder / "plan.json", {{"/fixture/rim_height_mm", 130}});
  const Outcome told = rondure({"plan", folder / "plan.json", "--json"});
  EXPECT_EQ(told.status, 2);
  EXPECT_THAT(told.err, AllOf(HasSubstr("/features/0/sampling: layer 1, point 1 (0.0 deg)"),
                              HasSubstr("the rim of the bowl"), HasSubstr("[unreachable]")));
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json["problems"][0]["code"], "unreachable");
}

TEST(PlanVerb, HasNothingToMoveForPointsFiles) {
  const Outcome told = rondure({"plan", example("09_axle_points_file.json")});
  EXPECT_EQ(told.status, 0) << told.err;
  EXPECT_THAT(told.out, HasSubstr("nothing would move"));
}

}  // namespace
}  // namespace rondure::app::testing
