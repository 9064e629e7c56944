// What a valid plan hardly means is said, with the likely meaning; what people do mean is not.

#include <string>
#include <string_view>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "plans/checks/doubts.h"
#include "plans/path/solid_mesh.h"
#include "tests/plans/files.h"

namespace rondure::plans {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines_of;

/// The doubts, a line each, about a shaft with two coaxial journals A and B, a face C and one more
/// cylinder with this characteristic.
std::string doubts_about(const std::string& characteristic) {
  const auto read = parse_plan(
      R"({"plan": {"name": "n", "revision": "A"}, "part": {"id": "p"}, "machine": {},
          "fixture": {}, "probe": {}, "simulation": {}, "features": [
          {"id": "a", "letter": "A", "type": "cylinder",
           "nominal": {"diameter_mm": 40, "from_mm": -80, "to_mm": -40},
           "sampling": {"margin_mm": 12}},
          {"id": "b", "letter": "B", "type": "cylinder",
           "nominal": {"diameter_mm": 40, "from_mm": 40, "to_mm": 80},
           "sampling": {"margin_mm": 12}},
          {"id": "c", "type": "cylinder",
           "nominal": {"diameter_mm": 50, "from_mm": -15, "to_mm": 15},
           "sampling": {"points_per_layer": 8},
           "characteristics": [)" +
          characteristic + "]}]}",
      "", "plan.json");
  if (!read) return "refused: " + lines_of(read);
  std::string out;
  for (const core::Error& doubt : doubts_of(*read)) out += doubt.where + ": " + doubt.what + "\n";
  return out;
}

TEST(Doubts, ALimitInTheWrongUnitIsNamedWithTheLikelyOne) {
  EXPECT_EQ(doubts_about(R"({"id": "x", "form": "cylindricity", "tolerance_um": 0.004})"),
            "/features/2/characteristics/0/tolerance_um: 0.004 um is 4 nm; was 4 um (0.004 mm) "
            "meant?\n");
  EXPECT_EQ(doubts_about(R"({"id": "x", "form": "diameter", "lower_um": -0.013, "upper_um": 0})"),
            "/features/2/characteristics/0/lower_um: -0.013 um is -13 nm; was -13 um (-0.013 mm) "
            "meant?\n");
  EXPECT_EQ(doubts_about(R"({"id": "x", "form": "cylindricity", "tolerance_um": 0.1},
                            {"id": "y", "form": "diameter", "lower_um": -13, "upper_um": 0})"),
            "");
}

TEST(Doubts, LimitsThatAreTheSizeItselfAreNamed) {
  EXPECT_EQ(
      doubts_about(R"({"id": "x", "form": "diameter", "lower_um": 49.987, "upper_um": 50})"),
      "/features/2/characteristics/0/lower_um: 49.987 and 50 read like the size itself; limits "
      "are deviations from the nominal diameter of 50 mm: were -13 and 0 um meant?\n");
  EXPECT_EQ(doubts_about(R"({"id": "x", "form": "diameter", "lower_um": 30, "upper_um": 60})"), "");
}

TEST(Doubts, ASecondDatumAxisOnTheFirstLocksNothing) {
  const auto about = [](const std::string& datum) {
    return doubts_about(R"({"id": "x", "form": "coaxiality", "tolerance_um": 8, "datum": )" +
                        datum + "}");
  };
  EXPECT_THAT(about(R"(["A", "B"])"),
              AllOf(HasSubstr("/features/2/characteristics/0/datum/1: the axis of \"B\" lies on "),
                    HasSubstr("was the common datum \"A-B\" meant?")));
  EXPECT_EQ(about(R"(["A-B"])"), "");
  EXPECT_EQ(about(R"(["A"])"), "");
}

TEST(Doubts, AProgramThatNoFormatWritesIsNamed) {
  Plan plan = testing::plan_of("06_wheel.json");
  plan.features.front().wheel->program.emplace();
  plan.reports.formats = {"html", "corrections"};
  EXPECT_TRUE(doubts_of(plan).empty());
  plan.reports.formats = {"html"};
  ASSERT_EQ(doubts_of(plan).size(), 1U);
  EXPECT_EQ(doubts_of(plan).front().where, "/features/0/wheel/program");
}

TEST(Doubts, ASeatThatCannotShowItsFormIsNamed) {
  Plan plan = testing::plan_of("21_fixture_on_holes.json");
  ASSERT_EQ(plan.fixture->datum->seat.size(), 4U);
  EXPECT_TRUE(doubts_of(plan).empty());
  plan.fixture->datum->seat.pop_back();
  ASSERT_EQ(doubts_of(plan).size(), 1U);
  EXPECT_EQ(doubts_of(plan).front().where, "/fixture/datum/seat");
  plan.fixture->datum.reset();
  BodyPlan body;
  body.file = "clamp.stl";
  for (const auto& [size_mm, unit, meant] : {std::tuple{4.7, record::LengthUnit::kMm, "inches"},
                                             {3048.0, record::LengthUnit::kInch, "millimetres"},
                                             {120.0, record::LengthUnit::kMm, ""}}) {
    body.mesh = SolidMesh::box({1.0, size_mm, 2.0}).value();
    body.unit = unit;
    plan.fixture->bodies = {body};
    const auto doubts = doubts_of(plan);
    ASSERT_EQ(doubts.empty(), std::string_view(meant).empty());
    if (doubts.empty()) continue;
    EXPECT_EQ(doubts.front().where, "/fixture/bodies/0/unit");
    EXPECT_NE(doubts.front().what.find(meant), std::string::npos) << doubts.front().what;
  }
}

}  // namespace
}  // namespace rondure::plans
