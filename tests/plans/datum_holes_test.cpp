#include "plans/run/internal/fixture_base.h"

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/noise.h"
#include "core/units.h"
#include "plans/forecast/forecast.h"
#include "tests/plans/fixture_base.h"

namespace rondure::plans {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::Ran;

constexpr double kTip_mm = testing::kSpoolTip_mm;

/// The base stands as its holes tell.
Plan plan_on_holes(const Vector3d& offset_mm, const Vector3d& rotation_deg) {
  using enum record::Side;
  DatumPlan datum;
  datum.holes = {{{-240.0, -150.0, 60.0}, 16.0, kInside, 10.0},
                 {{240.0, -150.0, 58.0}, 12.0, kInside, 12.0},
                 {{-240.0, 150.0, 60.0}, 20.0, kOutside, 24.0}};
  datum.seat = {{{-220.0, -180.0, 60.0}},
                {{220.0, -180.0, 60.0}},
                {{-220.0, 180.0, 60.0}},
                {{220.0, 180.0, 60.0}}};
  datum.uncertainty_mm = 2.0;
  return testing::spool_on(datum, offset_mm, rotation_deg);
}

/// Exact tip centres of seat and holes of a base that stands at X_WF.
std::vector<std::vector<Vector3d>> exact_tips(const DatumPlan& datum, const Isometry3d& X_WF) {
  std::vector<std::vector<Vector3d>> out(1);
  for (const DatumSeatPlan& at : datum.seat)
    out[0].push_back(X_WF * (Vector3d(at.point_mm.data()) + kTip_mm * Vector3d::UnitZ()));
  for (const DatumHolePlan& hole : datum.holes) {
    const double reach =
        0.5 * hole.diameter_mm + (hole.side == record::Side::kInside ? -kTip_mm : kTip_mm);
    auto& tips = out.emplace_back();
    for (int i = 0; i < 14; ++i) {
      const double t = core::kTwoPi * i / 7.0;
      tips.push_back(X_WF *
                     (Vector3d(hole.center_mm.data()) +
                      Vector3d(reach * std::cos(t), reach * std::sin(t), i < 7 ? 1.0 : 4.0)));
    }
  }
  return out;
}

TEST(DatumHoles, GiveTheBaseToANanometre) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {1});
    const auto draw = [&](double size) { return size * (2.0 * random.uniform() - 1.0); };
    const Vector3d offset(draw(0.8), draw(0.8), draw(0.8));
    const Vector3d rotation(draw(0.1), draw(0.1), draw(0.1));
    Plan plan = plan_on_holes(offset, rotation);
    if (seed == 3) plan.fixture->datum->holes.pop_back();  // two holes are enough
    const Ran result = testing::ran(plan);
    ASSERT_FALSE(result.failure) << result.failure->what;
    const auto found = fixture_base(plan, testing::base_touches(plan, result.record), kTip_mm);
    ASSERT_TRUE(found) << found.error().what;
    const Isometry3d truth = testing::base_at(offset, rotation);
    for (const Vector3d& p : {Vector3d(0.0, 0.0, 150.0), Vector3d(200.0, 150.0, 250.0)})
      EXPECT_LT((found->motion * p - truth * p).norm(), 1e-6);
    EXPECT_LT(found->largest_residual_mm, 1e-6);
    EXPECT_EQ(result.record.decisions.front().message.code, core::MessageCode::kFixtureBaseFound);
  }
}

TEST(DatumHoles, ScatterOfTheTurnIsThatOfTheSpecification) {
  // 1 um a coordinate on the corners of 180 x 120 mm turn the frame by 4.6 urad.
  Plan plan = plan_on_holes(Vector3d::Zero(), Vector3d::Zero());
  DatumPlan& datum = *plan.fixture->datum;
  datum.holes.clear();
  for (const double x : {-90.0, 90.0})
    for (const double y : {-60.0, 60.0})
      datum.holes.push_back({{x, y, 60.0}, 12.0, record::Side::kInside, 10.0});
  const auto exact = exact_tips(datum, Isometry3d::Identity());
  double squares = 0.0;
  constexpr int kRuns = 2000;
  for (int k = 0; k < kRuns; ++k) {
    core::KeyedNoise random(static_cast<std::uint64_t>(k), {2});
    auto tips = exact;
    for (std::size_t i = 1; i < tips.size(); ++i) {
      const Vector3d off(1e-3 * random.normal(), 1e-3 * random.normal(), 0.0);
      for (Vector3d& tip : tips[i]) tip += off;
    }
    const auto found = fixture_base(plan, tips, kTip_mm);
    ASSERT_TRUE(found) << found.error().what;
    const double turn_rad = found->motion.linear()(1, 0);
    squares += turn_rad * turn_rad;
  }
  EXPECT_NEAR(std::sqrt(squares / kRuns) * 1e6, 1e3 / std::sqrt(4.0 * (90.0 * 90.0 + 60.0 * 60.0)),
              0.3);
}

TEST(DatumHoles, RefuseWhatDoesNotFit) {
  const Plan plan = plan_on_holes(Vector3d::Zero(), Vector3d::Zero());
  const DatumPlan& datum = *plan.fixture->datum;
  const auto exact = exact_tips(datum, testing::base_at({0.3, -0.2, 0.1}, {0.02, -0.03, 0.05}));
  ASSERT_TRUE(fixture_base(plan, exact, kTip_mm));
  const auto refused = [&](const auto& change) {
    auto tips = exact;
    Plan other = plan;
    change(tips, *other.fixture->datum);
    const auto found = fixture_base(other, tips, kTip_mm);
    return found ? core::Error{} : found.error();
  };
  const auto moved = refused([](auto& tips, DatumPlan&) {
    for (auto& tip : tips[2]) tip.x() += 0.1;
  });
  EXPECT_EQ(moved.code, core::Code::kCalibration);
  EXPECT_EQ(moved.where, "/fixture/datum");
  EXPECT_THAT(moved.what, AllOf(HasSubstr("hole 2 of the fixture is "),
                                HasSubstr("the limit is 20 um (residual_limit_um)")));
  const auto wider = refused([](auto&, DatumPlan& wanted) { wanted.holes[1].diameter_mm = 12.3; });
  EXPECT_THAT(
      wider.what,
      HasSubstr("hole 2 of the fixture has a diameter of 12.000 mm, the plan says 12.3 mm"));
  const auto far = refused([](auto&, DatumPlan& wanted) { wanted.uncertainty_mm = 0.3; });
  EXPECT_EQ(far.code, core::Code::kLocation);
  EXPECT_THAT(far.what, HasSubstr("the plan allows 0.3 mm (uncertainty_mm)"));
  const auto high = refused([](auto& tips, DatumPlan&) {
    for (auto& tip : tips[0]) tip.z() += 3.0;
  });
  EXPECT_THAT(high.what, HasSubstr("the seat of the fixture is 2.9"));
  const auto chip = refused([](auto& tips, DatumPlan&) { tips[0][3].z() += 0.2; });
  EXPECT_THAT(chip.what, HasSubstr("the seat of the fixture has a form of "));
  const auto dirt =
      refused([](auto& tips, DatumPlan&) { tips[3][5] += Vector3d(0.02, 0.02, 0.0); });
  EXPECT_THAT(dirt.what, HasSubstr("dowel or bolt head 3 of the fixture has a form of "));
  const auto swapped = refused([](auto& tips, DatumPlan& wanted) {
    wanted.holes[0].diameter_mm = wanted.holes[1].diameter_mm = 12.0;
    std::swap(tips[1], tips[2]);
  });
  EXPECT_EQ(swapped.code, core::Code::kLocation);
  EXPECT_THAT(swapped.what, HasSubstr("hole 1 of the fixture stands 480."));
}

TEST(DatumHoles, ARunThatEndsAtAHoleSaysWhere) {
  Plan plan = plan_on_holes(Vector3d::Zero(), Vector3d::Zero());
  plan.simulation->fixture.base_offset_mm = {4.0, 0.0, 0.0};
  const auto off = testing::ran(plan).failure;
  ASSERT_TRUE(off);
  EXPECT_EQ(off->what,
            "hole 1 of the fixture stands 4.000 mm from its nominal place, the plan allows 2 mm "
            "(uncertainty_mm); check where the fixture is bolted");
  plan.simulation->fixture.base_offset_mm = {};
  plan.simulation->faults.connection_lost_at_touch = 13 + 4 + 14 + 3;  // sphere, seat, hole 1
  const auto lost = testing::ran(plan).failure;
  ASSERT_TRUE(lost);
  EXPECT_THAT(lost->what, HasSubstr("hole 2 of the fixture, point 3: "));
}

TEST(DatumHoles, AreTakenFromTheJournalByARunThatGoesOn) {
  testing::expect_resumed_bits(plan_on_holes({0.6, -0.2, 0.3}, {0.1, 0.05, -0.1}),
                               {14, 18, 26, 44, 58});
}

TEST(DatumHoles, AreForetold) {
  const Plan plan = plan_on_holes(Vector3d::Zero(), Vector3d::Zero());
  const auto told = forecast(plan);
  ASSERT_TRUE(told) << told.error().what;
  EXPECT_EQ(told->stages[1].kind, ForecastStage::Kind::kBase);
  int touches = 0;
  for (const ForecastStage& stage : told->stages)
    if (stage.kind == ForecastStage::Kind::kBase) touches += stage.touches;
  EXPECT_EQ(touches, 4 + 3 * 2 * 7);
  EXPECT_EQ(testing::ran(plan).record.touches.size(), static_cast<std::size_t>(told->touches));
}

TEST(DatumHoles, ADowelIsAnObstacle) {
  Plan plan = plan_on_holes(Vector3d::Zero(), Vector3d::Zero());
  plan.fixture->datum->holes[2] = {{-240.0, -135.0, 60.0}, 8.0, record::Side::kOutside, 60.0};
  const auto told = forecast(plan);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().code, core::Code::kUnreachable);
  EXPECT_THAT(told.error().what, HasSubstr("a dowel or bolt head of the fixture"));
}

TEST(DatumHoles, KeepWhatHoldsTheStylusAndTheParkedTipAboveThem) {
  nlohmann::json plan =
      nlohmann::json::parse(testing::bytes_of(testing::example("01_spool_simulated.json")));
  plan["probe"].update({{"stylus_length_mm", 60}, {"stylus_diameter_mm", 2}});
  auto& datum = plan["fixture"]["datum"];
  datum = nlohmann::json::parse(R"({"seat": [{"point_mm": [-220, -180, 60]},
    {"point_mm": [220, -180, 60]}, {"point_mm": [0, 180, 60]}], "holes": [
    {"center_mm": [-240, -150, 60], "diameter_mm": 12, "side": "outside", "depth_mm": 50},
    {"center_mm": [240, -150, 60], "diameter_mm": 12, "depth_mm": 50}]})");
  const auto read = [&] { return parse_plan(plan.dump(), "", "plan.json"); };
  EXPECT_TRUE(read()) << testing::lines_of(read());
  for (auto& hole : datum["holes"]) hole["depth_mm"] = 55;  // and 5 mm of clearance, 1 of place
  EXPECT_THAT(
      testing::lines_of(read()),
      AllOf(HasSubstr("/fixture/datum/holes/0/depth_mm: a stylus of 60 mm does not reach 55 "
                      "mm below the top with 6 mm of room"),
            HasSubstr("/fixture/datum/holes/1/depth_mm: a stylus of 60 mm does not reach 55 "
                      "mm below the mouth")));
  for (auto& hole : datum["holes"]) hole["depth_mm"] = 50;
  for (auto& at : datum["seat"]) at["point_mm"][2] = 495;
  EXPECT_THAT(testing::lines_of(read()), HasSubstr("park height 500 mm is below 503.000 mm"));
}

using Changes = std::vector<std::pair<const char*, nlohmann::json>>;

/// What validate says of example 21 with other values at these places; empty when nothing.
std::string told_of(const Changes& changes) {
  auto plan =
      nlohmann::json::parse(testing::bytes_of(testing::example("21_fixture_on_holes.json")));
  for (const auto& [place, value] : changes) plan[nlohmann::json::json_pointer(place)] = value;
  const auto read = parse_plan(plan.dump(), "", "plan.json");
  if (!read) return testing::lines_of(read);
  const auto told = forecast(*read);
  return told ? std::string() : told.error().where + ": " + told.error().what;
}

constexpr const char* kDowel = "/fixture/datum/holes/3/center_mm";
constexpr const char* kHeights = "/fixture/datum/heights";

TEST(DatumHoles, WhatAPathWouldMeetIsRefusedBeforeAnythingMoves) {
  using nlohmann::json;
  ASSERT_EQ(told_of({}), "");
  EXPECT_THAT(told_of({{"/fixture/rim_height_mm", 0},
                       {"/fixture/rim_diameter_mm", 100},
                       {kHeights, 1},
                       {kDowel, {0, 36.5, 60}},
                       {"/fixture/datum/holes/3/depth_mm", 30}}),
              HasSubstr("/fixture/datum/holes/3: it stands 70.230 mm"));
  // The tip rises from the last touch of the dowel, and a run that goes on comes down beside it.
  const json shelf = {{"id", "shelf"},
                      {"shape", "box"},
                      {"frame", "base"},
                      {"size_mm", {8, 30, 10}},
                      {"position_mm", {-20, 170, 150}}};
  EXPECT_THAT(
      told_of({{kHeights, 1}, {kDowel, {0, 170, 60}}, {"/fixture/bodies", json::array({shelf})}}),
      AllOf(HasSubstr("dowel or bolt head 4 of the fixture, point "),
            HasSubstr("to the body \"shelf\"")));
  // Dowels stand beside the reference sphere.
  EXPECT_THAT(
      told_of({{kHeights, 1}, {kDowel, {300, 26, 60}}, {"/fixture/datum/holes/3/depth_mm", 200}}),
      AllOf(HasSubstr("reference sphere, point "),
            HasSubstr("to a dowel or bolt head of the fixture")));
  // The base may lean by 2 mm over 30 mm of seat.
  EXPECT_THAT(
      told_of({{"/fixture/datum/seat/0/point_mm", {-15, -115, 60}},
               {"/fixture/datum/seat/1/point_mm", {15, -115, 60}},
               {"/fixture/datum/seat/2/point_mm", {15, -85, 60}},
               {"/fixture/datum/seat/3/point_mm", {-15, -85, 60}},
               {"/fixture/datum/holes/0/depth_mm", 100}}),
      AllOf(HasSubstr("/fixture/datum/holes/0/diameter_mm: a hole of 16 mm"), HasSubstr(" lean ")));
  EXPECT_THAT(told_of({{"/probe/stylus_length_mm", 60}, {"/probe/stylus_diameter_mm", 3.6}}),
              HasSubstr("/fixture/datum/holes/0/depth_mm: beside what may lean "));
}

TEST(DatumHoles, WhatWouldMisleadIsRefused) {
  EXPECT_THAT(told_of({{"/fixture/datum/holes/0/diameter_mm", 60},
                       {"/fixture/datum/seat/0/point_mm", {-226, -136, 60}}}),
              HasSubstr("/fixture/datum/seat/0/point_mm: it is 19.8 mm from the centre of hole 1, "
                        "at least 33 mm are needed"));
  EXPECT_THAT(told_of({{"/fixture/datum/seat/0/point_mm", {-300, 0, 60}},
                       {"/fixture/datum/seat/1/point_mm", {-299, 0, 60}},
                       {"/fixture/datum/seat/2/point_mm", {-299, 1, 60}},
                       {"/fixture/datum/seat/3/point_mm", {-300, 1, 60}}}),
              HasSubstr("/fixture/datum/seat: its places are as narrow as 1 mm, and the axes are"));
  nlohmann::json dowels;
  for (const double y_mm : {-150.0, -135.0})
    dowels.push_back({{"center_mm", {-240, y_mm, 60}},
                      {"diameter_mm", 8},
                      {"depth_mm", 24},
                      {"side", "outside"}});
  EXPECT_THAT(told_of({{"/fixture/datum/holes", dowels}}),
              HasSubstr("/fixture/datum/holes: they span only 15 mm, and the axes are 90 mm away"));
}

TEST(DatumHoles, MayStandSideBySide) {
  const Vector3d offset(0.3, -0.2, 0.1);
  const Vector3d rotation(0.02, -0.03, 0.05);
  Plan plan = plan_on_holes(offset, rotation);
  DatumPlan& datum = *plan.fixture->datum;
  datum.holes.push_back(datum.holes[0]);
  datum.holes.back().center_mm = {-221.0, -150.0, 60.0};  // 3 mm of metal between them
  datum.seat[0].point_mm = {-220.0, -100.0, 60.0};
  const Ran result = testing::ran(plan);
  ASSERT_FALSE(result.failure) << result.failure->what;
  const auto found = fixture_base(plan, testing::base_touches(plan, result.record), kTip_mm);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_LT(found->largest_residual_mm, 1e-6);
}

TEST(DatumHoles, ABaseThatTurnsABodyOutOfItsPlaceEndsTheRun) {
  Plan plan = plan_on_holes(Vector3d::Zero(), Vector3d::Zero());
  DatumPlan& datum = *plan.fixture->datum;
  datum.uncertainty_mm = 1.0;
  const auto leaning = testing::base_at({0.0, 0.0, 0.0}, {0.0, 0.0, 0.15});
  ASSERT_TRUE(fixture_base(plan, exact_tips(datum, leaning), kTip_mm));
  BodyPlan post;
  post.id = "post";
  post.position_mm = {600.0, 0.0, 0.0};
  post.diameter_mm = 20.0;
  post.to_mm = 300.0;
  plan.fixture->bodies = {post};
  const auto found = fixture_base(plan, exact_tips(datum, leaning), kTip_mm);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, core::Code::kLocation);
  EXPECT_THAT(found.error().what,
              AllOf(HasSubstr("its body \"post\" is 1.5"), HasSubstr("the plan allows 1 mm")));
}

TEST(DatumHoles, AFixtureFarOffIsSaidToBeOne) {
  for (const double z_mm : {8.0, -8.0}) {
    Plan plan = plan_on_holes({0.0, 0.0, z_mm}, Vector3d::Zero());
    const auto failure = testing::ran(plan).failure;
    ASSERT_TRUE(failure);
    EXPECT_THAT(failure->what, AllOf(HasSubstr("the seat of the fixture, point 1"),
                                     HasSubstr("the fixture may stand farther off than 2 mm")));
  }
}

}  // namespace
}  // namespace rondure::plans
