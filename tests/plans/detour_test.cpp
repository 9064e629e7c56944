// Ways around bodies that bar the straight ones, against an oracle that knows only boxes and the
// part: it samples every place of ball, shaft and holder on the way.

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "plans/checks/internal/plan_reach.h"
#include "plans/forecast/forecast.h"
#include "plans/path/internal/cloud_path.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/runner.h"
#include "tests/plans/files.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A box of the scene, along the axes of the machine.
struct Block {
  const char* id;
  Vector3d low;
  Vector3d high;
};

/// The spool of the first example, upright about (0, 0, 150), 50 mm thick and 80 mm high, touched
/// on one layer; its place is known, so that 5 mm of clearance are 5 mm.
Json spool(const std::vector<Block>& blocks, double tip_mm, double shaft_mm) {
  Json out = Json::parse(testing::bytes_of(testing::example("01_spool_simulated.json")));
  out["part"]["location_uncertainty_mm"] = 0;
  out["fixture"]["axis_offset_mm"] = {0, 0, 0};
  out["fixture"]["bodies"] = Json::array();
  for (const Block& b : blocks) {
    const Vector3d middle = 0.5 * (b.low + b.high);
    const Vector3d size = b.high - b.low;
    out["fixture"]["bodies"].push_back({{"id", b.id},
                                        {"shape", "box"},
                                        {"size_mm", {size.x(), size.y(), size.z()}},
                                        {"position_mm", {middle.x(), middle.y(), middle.z()}}});
  }
  out["probe"]["tip_diameter_mm"] = tip_mm;
  if (shaft_mm > 0.0) {
    out["probe"]["stylus_length_mm"] = 120;
    out["probe"]["stylus_diameter_mm"] = shaft_mm;
  }
  out["features"][0]["sampling"] = {{"layers", 3}, {"points_per_layer", 6}, {"margin_mm", 20}};
  return out;
}

double from_block(const Block& b, const Vector3d& p) {
  return (b.low - p).cwiseMax(p - b.high).cwiseMax(0.0).norm();
}

/// Least distance, beyond ball or shaft, of the tool on a way from the blocks and from the part.
std::pair<double, double> least_gaps(const std::vector<Block>& blocks, const Plan& plan,
                                     const Polyline& way) {
  double block = 1e9;
  double part = 1e9;
  const auto look = [&](const Vector3d& p, double radius_mm) {
    for (const Block& b : blocks) block = std::min(block, from_block(b, p) - radius_mm);
    part = std::min(part, std::hypot(std::max(0.0, p.head<2>().norm() - 25.0),
                                     std::max(0.0, std::abs(p.z() - 150.0) - 40.0)) -
                              radius_mm);
  };
  for (std::size_t i = 1; i < way.size(); ++i) {
    const int steps = static_cast<int>(std::ceil((way[i] - way[i - 1]).norm() / 0.5)) + 1;
    for (int k = 0; k <= steps; ++k) {
      const Vector3d tip = way[i - 1] + (way[i] - way[i - 1]) * k / steps;
      look(tip, 0.5 * plan.probe->tip_diameter_mm);
      for (double up = 0.0; up <= plan.probe->stylus_length_mm; up += 2.0) {
        look(tip + up * Vector3d::UnitZ(), 0.5 * plan.probe->stylus_diameter_mm);
      }
    }
  }
  return {block, part};
}

struct Found {
  std::string refused;
  Polyline moves;  ///< The whole cloud.
};

/// Lays the cloud of a scene and holds every move against the oracle.
Found lay(const std::vector<Block>& blocks, double tip_mm, double shaft_mm) {
  const auto plan = parse_plan(spool(blocks, tip_mm, shaft_mm).dump(), {}, "plan.json");
  if (!plan) return {testing::lines_of(plan), {}};
  const FeaturePlan& feature = plan->features.front();
  const PathGeometry geometry = path_geometry(*plan, feature, 0.0);
  Placement placement;
  placement.X_WP.translation() = Vector3d(0.0, 0.0, 150.0);
  placement.X_WN = placement.X_WP;
  const Scene scene(*plan, feature);
  const auto targets = sampling_targets(feature).value();
  std::vector<std::size_t> own(targets.size());
  std::iota(own.begin(), own.end(), std::size_t{0});
  const CloudPath path(scene, placement, geometry, 500.0, targets, own);
  Found out;
  for (std::size_t k = 0; k < targets.size(); ++k) {
    for (const Vector3d& corner : path.way_W(k)) out.moves.push_back(corner);
  }
  for (const Vector3d& corner : path.exit_W(targets.size() - 1)) out.moves.push_back(corner);
  const auto [block, part] = least_gaps(blocks, *plan, out.moves);
  EXPECT_GE(block, 5.0 - 1e-6);
  EXPECT_GE(part, 3.0 - 1e-6);
  return out;
}

/// A wall that leaves room for a pre-touch point, 30 mm from the axis with a ball of 4 mm, and none
/// for the path around at 32.3 mm.
const Block kWall = {"wall", {37.5, -60.0, 95.0}, {47.5, 60.0, 300.0}};

TEST(Detour, RisesBesideAWallThatLeavesNoRoomForThePathAround) {
  const Found open = lay({}, 4.0, 2.0);
  ASSERT_EQ(open.refused, "");
  const Found found = lay({kWall}, 4.0, 2.0);
  ASSERT_EQ(found.refused, "");
  EXPECT_NE(found.moves, open.moves);
  EXPECT_EQ(found.moves, lay({kWall}, 4.0, 2.0).moves) << "same scene, same way";
  Block nearer = kWall;
  nearer.low.x() = 36.9;
  EXPECT_THAT(lay({nearer}, 4.0, 2.0).refused,
              AllOf(HasSubstr("would come nearer than 5 mm (machine.clearance_mm) to the body "
                              "\"wall\" on the way to machine")));
}

TEST(Detour, LeadsAroundALedgeThatTheBallCannotPassUpward) {
  // The shaft, 2 mm thick, keeps 5 mm from the ledge above the touch, the ball of 8 mm would not.
  const Block ledge = {"ledge", {39.0, -30.0, 200.0}, {80.0, 30.0, 210.0}};
  const Found found = lay({ledge}, 8.0, 2.0);
  ASSERT_EQ(found.refused, "");
  Block nearer = ledge;
  nearer.low.x() = 37.5;
  EXPECT_THAT(lay({nearer}, 8.0, 2.0).refused, HasSubstr("the shaft of the stylus would come"));
}

TEST(Detour, PassesAWallBetweenTwoTouches) {
  const Found found = lay({{"wall", {45.0, 12.0, 95.0}, {90.0, 16.0, 300.0}},
                           {"sill", {33.5, 22.0, 140.0}, {90.0, 26.0, 300.0}}},
                          4.0, 2.0);
  EXPECT_EQ(found.refused, "");
}

/// A bell over the spool, for a ball alone: four walls down to below the rim, and a roof with a
/// slot of this width along x.
std::vector<Block> bell(double slot_mm) {
  std::vector<Block> out = {{"x+", {70.0, -80.0, 60.0}, {80.0, 80.0, 260.0}},
                            {"x-", {-80.0, -80.0, 60.0}, {-70.0, 80.0, 260.0}},
                            {"y+", {-80.0, 70.0, 60.0}, {80.0, 80.0, 260.0}},
                            {"y-", {-80.0, -80.0, 60.0}, {80.0, -70.0, 260.0}}};
  const double half = 0.5 * slot_mm;
  out.push_back({"roof y+", {-80.0, 50.0 + half, 250.0}, {80.0, 80.0, 260.0}});
  out.push_back({"roof", {-80.0, -80.0, 250.0}, {80.0, 50.0 - half, 260.0}});
  return out;
}

TEST(Detour, LeavesABellByASlotAsWideAsTipAndClearanceAlone) {
  const Found found = lay(bell(24.0), 4.0, 0.0);
  ASSERT_EQ(found.refused, "");
  const double highest =
      std::ranges::max(found.moves, {}, [](const Vector3d& p) { return p.z(); }).z();
  EXPECT_EQ(highest, 500.0);
  for (const double slot_mm : {13.5, 3.0, 0.0}) {
    SCOPED_TRACE(slot_mm);
    EXPECT_THAT(lay(bell(slot_mm), 4.0, 0.0).refused,
                AllOf(HasSubstr("layer 1, point 1"), HasSubstr("to the body \"roof")));
  }
}

TEST(Detour, IsTakenByForecastAndRunAlike) {
  Json text = spool({kWall}, 4.0, 2.0);
  text["features"][0]["pose_search"] = {{"strategy", "start-pose"}, {"repeats", 1}};
  text["simulation"]["part"] = Json::object();
  const auto plan = parse_plan(text.dump(), {}, "plan.json");
  ASSERT_TRUE(plan) << testing::lines_of(plan);
  const auto foretold = forecast(*plan);
  ASSERT_TRUE(foretold) << foretold.error().what;
  const record::Scratch scratch;
  const auto run = run_plan(*plan, testing::options_for(scratch / "run"));
  ASSERT_TRUE(run) << run.error().what;
  EXPECT_FALSE(run->failure) << run->failure->what;
  const auto& stages = foretold->stages;
  const auto cloud = std::ranges::find(stages, true, &ForecastStage::final_cloud);
  ASSERT_NE(cloud, stages.end());
  EXPECT_GE(least_gaps({kWall}, *plan, cloud->moves_W).first, 5.0 - 1e-6);
}

}  // namespace
}  // namespace rondure::plans
