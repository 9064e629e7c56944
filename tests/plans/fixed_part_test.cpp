// A part on a CMM without a fixture: where it is, what holds it, and what its first touch decides.

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/shortest_turn.h"
#include "core/units.h"
#include "evaluation/evaluate.h"
#include "plans/forecast/forecast.h"
#include "plans/run/runner.h"
#include "tests/core/full.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::lines_of;

/// The example without a fixture, changed by a merge patch.
Json fixed_json(const Json& patch = Json::object()) {
  Json out = Json::parse(testing::bytes_of(testing::example("17_cmm_without_fixture.json")));
  out.erase("uncertainty");
  out["decision_rule"]["rule"] = "simple-acceptance";
  out.merge_patch(patch);
  return out;
}

PlanOrProblems fixed_plan(const Json& patch = Json::object()) {
  return parse_plan(fixed_json(patch).dump(), "", "plan.json");
}

struct FixedRun : testing::Ran {
  std::size_t on_part = 0;  ///< Touches of the part.
};

FixedRun fixed_run(const Json& patch = Json::object()) {
  FixedRun out{testing::ran(fixed_plan(patch))};
  out.on_part = static_cast<std::size_t>(
      std::count_if(out.record.touches.begin(), out.record.touches.end(),
                    [](const record::Touch& touch) { return touch.pose >= 0; }));
  return out;
}

/// Moves the simulated part away from where the plan has it.
Json fixed_moved(double x_mm, double z_mm) {
  return {{"simulation", {{"fixture", {{"base_offset_mm", {x_mm, 0, z_mm}}}}}}};
}

TEST(FixedPart, IsWhatAPlanWithoutAFixtureHasAndSearchesNoPose) {
  const auto plan = fixed_plan();
  ASSERT_TRUE(plan) << lines_of(plan);
  EXPECT_EQ(plan->fixture->driver, FixturePlan::Driver::kFixed);
  for (const FeaturePlan& feature : plan->features) {
    EXPECT_EQ(feature.pose_search.strategy, record::Strategy::kStartPose);
  }
  const auto said = fixed_plan({{"fixture", {{"driver", "fixed"}, {"table_height_mm", 50}}}});
  ASSERT_TRUE(said) << lines_of(said);
  EXPECT_EQ(said->fixture->axis_point_mm, plan->part.position_mm);
  const auto of_file = parse_plan(testing::bytes_of(testing::example("09_axle_points_file.json")),
                                  testing::example(""), "p");
  ASSERT_TRUE(of_file) << lines_of(of_file);
  EXPECT_FALSE(of_file->fixture) << "points of a file need none";
}

TEST(FixedPart, IsMeasuredWhereThePlanHasItInOnePoseWithTheForetoldTouches) {
  const FixedRun result = fixed_run();
  ASSERT_FALSE(result.failure) << result.failure->what;
  EXPECT_EQ(result.record.header.fixture, "none, the part stands still");
  for (const record::PoseVisit& visit : result.record.poses) {
    EXPECT_EQ(visit.reached, core::Pose());
  }
  const auto told = forecast(*fixed_plan());
  ASSERT_TRUE(told) << told.error().what;
  EXPECT_EQ(result.record.touches.size(), static_cast<std::size_t>(told->touches));
}

TEST(FixedPart, MayLeanAsItsAxisSays) {
  const Json leans = {{"part", {{"axis", {0.06, -0.03, 1.0}}}}};
  const FixedRun result = fixed_run(leans);
  ASSERT_FALSE(result.failure) << result.failure->what;
  // The simulated part leans as the plan has it.
  const Eigen::Vector3d first = result.record.touches.back().tip_mm;
  const Eigen::Vector3d upright = fixed_run().record.touches.back().tip_mm;
  EXPECT_GT((first - upright).norm(), 1.0);
}

/// Every kind of surface and characteristic whose evaluation starts at the axis of the part,
/// without noise, leaning from machine z towards an azimuth.
Json leaning(double lean_deg, double azimuth_deg) {
  const double lean = lean_deg * core::kDegree;
  const double azimuth = azimuth_deg * core::kDegree;
  Json out = fixed_json();
  out["part"]["position_mm"] = {120, 80, 250};
  out["part"]["axis"] = {std::sin(lean) * std::cos(azimuth), std::sin(lean) * std::sin(azimuth),
                         std::cos(lean)};
  out["simulation"]["probe"].erase("repeatability_um");
  // Not an oval: the cylinder round it touches two lines of points, on which the rounding of their
  // coordinates, another one in each direction, lets it rock by 0.05 um.
  out["simulation"]["features"][0]["lobes"] = {{{"order", 3}, {"amplitude_um", 0.7}}};
  Json& a = out["features"][0];
  a["characteristics"].push_back(
      {{"id", "GG"}, {"form", "diameter"}, {"size", "GG"}, {"lower_um", -20}, {"upper_um", 20}});
  Json& b = out["features"][1];  // no keyway in A: a datum axis is then any of a flat optimum
  b["exclude"] = {{{"name", "keyway"}, {"from_deg", 40}, {"to_deg", 80}}};
  b["characteristics"].push_back(
      {{"id", "total"}, {"form", "total-run-out"}, {"datum", {"A"}}, {"tolerance_um", 20}});
  b["characteristics"].push_back({{"id", "line"}, {"form", "straightness"}, {"tolerance_um", 20}});
  out["features"].push_back(Json::parse(R"({"id": "end", "type": "plane", "nominal": {"z_mm": 50,
      "faces": "up", "from_diameter_mm": 6, "to_diameter_mm": 28}, "sampling": {"layers": 2,
      "points_per_layer": 6, "margin_mm": 4}, "characteristics": [
      {"id": "flat", "form": "flatness", "tolerance_um": 5},
      {"id": "square", "form": "perpendicularity", "datum": ["A"], "tolerance_um": 200}]})"));
  out["features"].push_back(Json::parse(R"({"id": "ring", "type": "circle", "nominal": {
      "diameter_mm": 30, "from_mm": 12, "to_mm": 48}, "sampling": {"points_per_layer": 12},
      "characteristics": [{"id": "RONt", "form": "roundness", "tolerance_um": 6}]})"));
  return out;
}

evaluation::Evaluation evaluated(const Json& json) {
  const record::Scratch scratch;
  const auto plan = parse_plan(json.dump(), "", "plan.json");
  EXPECT_TRUE(plan) << lines_of(plan);
  if (!plan) return {};
  const auto done = run_plan(*plan, testing::options_for(scratch / "run"));
  EXPECT_TRUE(done && !done->failure) << (done ? done->failure->what : done.error().what);
  const auto out = evaluation::evaluate(testing::journal_of(scratch / "run"));
  return out ? *out : evaluation::Evaluation();
}

TEST(FixedPart, HasTheSameResultsHoweverItLeans) {
  constexpr double kSame_mm = 1e-6;
  constexpr double kSame_rad = 1e-6;
  const evaluation::Evaluation upright = evaluated(leaning(0.0, 0.0));
  ASSERT_EQ(upright.features.size(), 4U);
  std::vector<std::pair<double, double>> leans_deg = {{30.0, 70.0}, {60.0, 235.0}, {90.0, 0.0}};
  if (test::full()) {
    for (const double lean_deg : {30.0, 52.0, 55.0, 60.0, 80.0, 90.0}) {
      for (const double to_deg : {0.0, 70.0, 180.0, 235.0, 270.0}) {
        leans_deg.emplace_back(lean_deg, to_deg);
      }
    }
  }
  for (const auto& [lean_deg, azimuth_deg] : leans_deg) {
    SCOPED_TRACE(fmt::format("leans {} deg towards {} deg", lean_deg, azimuth_deg));
    const Json plan = leaning(lean_deg, azimuth_deg);
    const evaluation::Evaluation leans = evaluated(plan);
    ASSERT_EQ(leans.features.size(), upright.features.size());
    const auto axis = plan["part"]["axis"].get<std::array<double, 3>>();
    const Eigen::Matrix3d turn =
        core::shortest_turn(Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Map(axis.data()));
    for (std::size_t f = 0; f < leans.features.size(); ++f) {
      const evaluation::FeatureResult& here = leans.features[f];
      const evaluation::FeatureResult& there = upright.features[f];
      SCOPED_TRACE(here.feature.id);
      ASSERT_FALSE(here.failure) << here.failure->what;
      ASSERT_EQ(here.characteristics.size(), there.characteristics.size());
      for (std::size_t c = 0; c < here.characteristics.size(); ++c) {
        const auto& value = here.characteristics[c];
        SCOPED_TRACE(value.characteristic.id);
        ASSERT_TRUE(value.value_mm()) << value.reason.english();
        EXPECT_NEAR(*value.value_mm(), *there.characteristics[c].value_mm(), kSame_mm);
        EXPECT_EQ(value.verdict, there.characteristics[c].verdict);
      }
      ASSERT_EQ(here.cloud.size(), there.cloud.size());
      for (std::size_t row = 0; row < here.cloud.size(); ++row) {
        const bool plane = here.feature.shape == record::Shape::kPlane;  // its zero is any
        const double turned_rad = here.cloud[row].angle_rad - there.cloud[row].angle_rad;
        EXPECT_NEAR(plane ? 0.0 : std::remainder(turned_rad, core::kTwoPi), 0.0, kSame_rad);
        EXPECT_NEAR(here.cloud[row].height_mm, there.cloud[row].height_mm, 10.0 * kSame_mm);
        EXPECT_EQ(here.cloud[row].left_out, there.cloud[row].left_out);
      }
      EXPECT_TRUE(here.poses.empty());
      if (!here.mz_cylinder) continue;
      const Eigen::Vector3d found = turn.transpose() * here.mz_cylinder->axis.direction;
      EXPECT_NEAR(found.cross(there.mz_cylinder->axis.direction).norm(), 0.0, kSame_rad);
      EXPECT_NEAR(here.mz_cylinder->outer_radius_mm, there.mz_cylinder->outer_radius_mm, kSame_mm);
    }
  }
}

TEST(FixedPart, IsKeptClearOfWhatHoldsIt) {
  const auto in_band = fixed_plan({{"part", {{"held", {{"from_mm", -72}, {"to_mm", -65}}}}}});
  EXPECT_THAT(lines_of(in_band), HasSubstr("lies in the clamped band"));
  const auto near_band = fixed_plan({{"part", {{"held", {{"to_mm", -73}}}}}});
  EXPECT_THAT(lines_of(near_band), HasSubstr("to what holds the part (part.held)"));
}

TEST(FixedPart, NeedsRoomBesideTheReferenceSphereAndBelowThePark) {
  const auto beside = fixed_plan({{"part", {{"position_mm", {262, 0, 160}}}}});
  EXPECT_THAT(lines_of(beside), HasSubstr("the centre of the reference sphere is 23.000 mm"));
  EXPECT_TRUE(fixed_plan({{"part", {{"position_mm", {200, 0, 160}}}}}));
  EXPECT_THAT(lines_of(fixed_plan({{"machine", {{"park_mm", {0, 0, 215}}}}})),
              HasSubstr("park height 215 mm is below 217.0"));
}

TEST(FixedPart, WhoseFirstTouchMissesStopsWithTheDistanceBeforeAnythingElse) {
  const FixedRun result = fixed_run(fixed_moved(50.0, 0.0));
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->code, core::Code::kNoTouch) << result.failure->what;
  EXPECT_THAT(result.failure->what, AllOf(HasSubstr("no contact within 3.500 mm"),
                                          HasSubstr("the part is not within 3.5 mm of its place in "
                                                    "the plan; nothing else has moved")));
  EXPECT_EQ(result.on_part, 0U);
}

TEST(FixedPart, WhoseFirstTouchIsFartherOffThanTheSearchStopsWithTheDistance) {
  // Found late or early, whichever of six directions comes first: the longer search of an unlocated
  // part meets it.
  for (const double off_mm : {4.0, -4.0}) {
    SCOPED_TRACE(off_mm);
    Json patch = fixed_moved(off_mm, 0.0);
    patch["part"]["location_uncertainty_mm"] = 4.5;
    patch["machine"]["approach_mm"] = 4.5;
    patch["machine"]["search_mm"] = 1.0;
    const FixedRun result = fixed_run(patch);
    ASSERT_TRUE(result.failure);
    EXPECT_EQ(result.failure->code, core::Code::kLocation) << result.failure->what;
    EXPECT_THAT(result.failure->what, AllOf(HasSubstr("the first touch met the part "),
                                            HasSubstr("machine.search_mm allows 1 mm; nothing else "
                                                      "has moved")));
    EXPECT_EQ(result.on_part, 1U);
    patch["machine"]["search_mm"] = 5.0;
    EXPECT_GT(fixed_run(patch).on_part, 1U);
  }
}

/// The simulated part stands elsewhere and turned; the control has it aligned there.
Json in_part_system() {
  return {{"part", {{"system", "control"}}},
          {"simulation",
           {{"fixture", {{"base_offset_mm", {-30, 20, 15}}, {"base_rotation_deg", {1, -2, 8}}}}}}};
}

/// The part is 2 mm beside and 1.8 mm above its place; a face and journal A show it.
Json fixed_aligned() {
  Json out = fixed_json(fixed_moved(2.0, 1.8));
  out["part"]["location_uncertainty_mm"] = 2.5;
  out["part"]["alignment"] = {{"axis", "journal A"}, {"face", "end"}};
  out["features"].push_back(Json::parse(R"({"id": "end", "type": "plane", "nominal": {"z_mm": 50,
      "faces": "up", "from_diameter_mm": 6, "to_diameter_mm": 28}, "sampling": {"layers": 2,
      "points_per_layer": 6, "margin_mm": 4}, "characteristics": []})"));
  return {{"part", out["part"]}, {"features", out["features"]}, {"simulation", out["simulation"]}};
}

/// Mean height of the measuring touches of the first layer of a feature.
double first_layer_mm(const record::RunRecord& run, int feature) {
  double sum_mm = 0.0;
  int count = 0;
  for (const record::Touch& touch : run.touches) {
    if (touch.pose < 0 || touch.layer != 0 || touch.purpose != record::Touch::Purpose::kMeasure ||
        run.poses[static_cast<std::size_t>(touch.pose)].feature != feature) {
      continue;
    }
    sum_mm += touch.tip_mm.z();
    ++count;
  }
  return sum_mm / count;
}

TEST(FixedPart, IsMeasuredInThePartSystemOfTheControlWhereverThatIs) {
  const FixedRun result = fixed_run(in_part_system());
  ASSERT_FALSE(result.failure) << result.failure->what;
  const core::Message& found = result.record.decisions.front().message;
  ASSERT_EQ(found.code, core::MessageCode::kFixtureBaseFound);
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(8.0 * core::kDegree, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(-2.0 * core::kDegree, Eigen::Vector3d::UnitY()) *
                             Eigen::AngleAxisd(1.0 * core::kDegree, Eigen::Vector3d::UnitX()))
                                .toRotationMatrix();
  const Eigen::AngleAxisd turn(R);
  const Eigen::Vector3d shift_mm(-30.0, 20.0, 15.0);
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_NEAR(found.number(i), shift_mm[k], 1e-6);
    EXPECT_NEAR(found.number(i + 3), turn.angle() * turn.axis()[k] / core::kDegree, 1e-7);
  }
  EXPECT_NEAR(found.number(6), 0.0, 1e-3);
  Json unaligned = in_part_system();
  unaligned.erase("part");
  EXPECT_TRUE(fixed_run(unaligned).failure) << "its place in the plan is another";
}

TEST(FixedPart, IsAlignedByAFaceAndTwoSectionsBeforeItIsMeasured) {
  const FixedRun result = fixed_run(fixed_aligned());
  ASSERT_FALSE(result.failure) << result.failure->what;
  EXPECT_EQ(result.record.decisions.front().message.code, core::MessageCode::kFixtureBaseFound);
  EXPECT_NEAR(first_layer_mm(result.record, 0), first_layer_mm(fixed_run().record, 0) + 1.8, 0.02);
  const auto told = forecast(*fixed_plan(fixed_aligned()));
  ASSERT_TRUE(told) << told.error().what;
  EXPECT_EQ(result.record.touches.size(), static_cast<std::size_t>(told->touches));
  Json no_plane = fixed_aligned();
  no_plane["part"]["alignment"]["face"] = "journal B";
  EXPECT_THAT(lines_of(fixed_plan(no_plane)),
              HasSubstr("/part/alignment/face: \"journal B\" is no touched plane of this plan"));
}

TEST(FixedPart, BesideItsPlaceIsFoundWithinTheStatedUncertaintyAndStopsTheRunBeyondIt) {
  std::vector<double> offs_mm = {0.5, -1.0, 2.0, -5.0};
  if (test::full()) offs_mm.insert(offs_mm.end(), {-0.5, 1.0, -2.0, 5.0});
  for (const bool aligned : {false, true}) {
    for (const double stated_mm : {0.5, 2.0}) {
      for (int axis = 0; axis < (aligned ? 3 : 2); ++axis) {  // only a face shows the height
        for (const double off_mm : offs_mm) {
          SCOPED_TRACE(fmt::format("{}, {} mm along {}, {} mm stated",
                                   aligned ? "aligned" : "located", off_mm, axis, stated_mm));
          Json patch = aligned ? fixed_aligned() : Json::object();
          patch["part"]["location_uncertainty_mm"] = stated_mm;
          patch["simulation"]["part"] = nullptr;
          Json& offset = patch["simulation"]["fixture"]["base_offset_mm"] = {0.0, 0.0, 0.0};
          offset[static_cast<std::size_t>(axis)] = off_mm;
          const FixedRun result = fixed_run(patch);
          if (std::abs(off_mm) <= stated_mm) {
            EXPECT_FALSE(result.failure) << result.failure->what;
            EXPECT_EQ(result.record.ending, "finished");
            continue;
          }
          ASSERT_TRUE(result.failure);
          for (const record::Touch& touch : result.record.touches) {
            EXPECT_TRUE(touch.pose < 0 || touch.purpose == record::Touch::Purpose::kLocate);
          }
          // The first approach begins 3 mm and the stated uncertainty before the nominal surface.
          if (std::abs(off_mm) >= 3.0 + stated_mm) continue;
          EXPECT_EQ(result.failure->code, core::Code::kLocation) << result.failure->what;
          EXPECT_THAT(
              result.failure->what,
              AllOf(HasSubstr(fmt::format("location_uncertainty_mm allows {:g} mm", stated_mm)),
                    HasSubstr("place the part anew")));
        }
      }
    }
  }
}

TEST(FixedPart, WhoseHeightNoTouchShowsMayBeOffByLessThanItsPathsKeep) {
  const auto high = fixed_plan({{"part", {{"location_uncertainty_mm", 3.5}}}});
  EXPECT_THAT(lines_of(high),
              AllOf(HasSubstr("/part/location_uncertainty_mm: no touch shows the height of the "
                              "part, which may be 3.5 mm off along its axis, and the tip keeps 3 "
                              "mm from it"),
                    HasSubstr("part.alignment")));
  Json narrow = fixed_json({{"part", {{"location_uncertainty_mm", 2.0}}}});
  narrow["features"][1]["nominal"]["to_mm"] = 14;
  narrow["features"][1]["sampling"]["margin_mm"] = 1;
  EXPECT_THAT(lines_of(parse_plan(narrow.dump(), "", "plan.json")),
              HasSubstr("the touches that locate \"journal B\" lie 1.6 mm from its ends"));
}

TEST(FixedPart, IsContainedInWhatHoldsIt) {
  EXPECT_THAT(lines_of(fixed_plan({{"part", {{"held", {{"diameter_mm", 20}}}}}})),
              HasSubstr("/part/held/diameter_mm: 20 mm is less than the part, 26 mm"));
  EXPECT_TRUE(fixed_plan({{"part", {{"held", {{"diameter_mm", 26}}}}}}));
}

TEST(FixedPart, IsFoundFromTheJournalByARunThatGoesOn) {
  for (const Json& patch : {in_part_system(), fixed_aligned()}) {
    const auto plan = fixed_plan(patch);
    ASSERT_TRUE(plan) << lines_of(plan);
    testing::expect_resumed_bits(*plan, {4, 13, 15, 20, 40});
  }
}

TEST(FixedPart, WithoutFormConformsUnderIso14253WhateverErrorsAreDeclared) {
  Json plan = Json::parse(testing::bytes_of(testing::example("17_cmm_without_fixture.json")));
  plan["simulation"] = Json::object();
  plan["uncertainty"]["budget_trials"] = 0;
  // The typical probe has lobes of 0.6 um; what is declared far below that proves nothing.
  plan["uncertainty"]["probe"]["lobes"][0]["amplitude_um"] = 0.6;
  for (const bool spectrum : {true, false}) {
    SCOPED_TRACE(spectrum);
    if (!spectrum) plan["uncertainty"].erase("form_spectrum");
    const record::Scratch scratch;
    const auto perfect = parse_plan(plan.dump(), "", "plan.json");
    ASSERT_TRUE(perfect) << lines_of(perfect);
    const auto done = run_plan(*perfect, testing::options_for(scratch / "run"));
    ASSERT_TRUE(done && !done->failure);
    const auto evaluation = evaluation::evaluate(testing::journal_of(scratch / "run"));
    ASSERT_TRUE(evaluation);
    EXPECT_EQ(evaluation->verdict, evaluation::Verdict::kConforms);
    for (const auto& feature : evaluation->features) {
      for (const auto& characteristic : feature.characteristics) {
        EXPECT_EQ(characteristic.verdict, evaluation::Verdict::kConforms)
            << characteristic.characteristic.id << ": " << characteristic.reason.english();
      }
    }
  }
}

}  // namespace
}  // namespace rondure::plans
