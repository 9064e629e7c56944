#include "plans/path/travel.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmm/simulated/machine.h"
#include "core/noise.h"
#include "core/units.h"
#include "tests/plans/random_inspection.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using test::between;
using ::testing::HasSubstr;

struct PathCase {
  FeaturePlan feature;
  PathGeometry geometry;
  std::vector<Target> targets;
};

PathCase random_case(core::KeyedNoise& random, bool inside) {
  PathCase c;
  const double from = between(random, -50.0, 20.0);
  const double to = from + between(random, 30.0, 90.0);
  const double diameter = between(random, 24.0, 90.0);
  c.feature.nominal = {diameter, from, to};
  c.feature.sampling.layers = 1 + static_cast<int>(between(random, 0.0, 5.0));
  c.feature.sampling.points_per_layer = 3 + static_cast<int>(between(random, 0.0, 12.0));
  c.feature.sampling.start_deg = between(random, -180.0, 180.0);
  c.geometry = {diameter / 2,
                from,
                to,
                inside,
                between(random, 0.5, 3.0),
                between(random, 1.5, 6.0),
                between(random, 2.0, 10.0),
                0.0};
  c.targets = *sampling_targets(c.feature);
  return c;
}

/// All moves of a program in the part frame, one polyline a target and the way out.
std::vector<Polyline> program(const PathCase& c) {
  std::vector<Polyline> ways = {entry_path(c.geometry, c.targets.front())};
  for (std::size_t i = 1; i < c.targets.size(); ++i) {
    ways.push_back(path_between(c.geometry, c.targets[i - 1], c.targets[i]));
  }
  ways.push_back(exit_path(c.geometry, c.targets.back()));
  return ways;
}

/// Signed distance from a rectangle [r0, r1] x [z0, z1] of the (r, z) half plane.
double from_rectangle(double r, double z, double r0, double r1, double z0, double z1) {
  const double dr = std::max(r0 - r, r - r1);
  const double dz = std::max(z0 - z, z - z1);
  if (dr > 0.0 && dz > 0.0) return std::hypot(dr, dz);
  return std::max(dr, dz);
}

double distance_to_part(const PathGeometry& g, const Vector3d& p) {
  const double r = p.head<2>().norm();
  if (g.inside) {
    return from_rectangle(r, p.z(), g.radius_mm, g.radius_mm + cmm::kBlockWall_mm, g.from_mm,
                          g.to_mm);
  }
  return from_rectangle(r, p.z(), -g.radius_mm, g.radius_mm, g.from_mm, g.to_mm);
}

TEST(Travel, EveryPlaceOfEveryPathKeepsItsDistanceFromTheNominalPart) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {1});
    const PathCase c = random_case(random, seed % 2 == 1);
    if (!check_fits(c.geometry)) continue;
    const double keep_off =
        c.geometry.tip_radius_mm + std::min(c.geometry.approach_mm, c.geometry.clearance_mm) - 1e-9;
    for (const Polyline& way : program(c)) {
      for (std::size_t i = 1; i < way.size(); ++i) {
        for (double t = 0.0; t <= 1.0; t += 1.0 / 256) {
          ASSERT_GE(distance_to_part(c.geometry, (1 - t) * way[i - 1] + t * way[i]), keep_off);
        }
      }
    }
  }
}

TEST(Travel, PathsJoinTheTargetsInTheirOrder) {
  core::KeyedNoise random(1, {2});
  for (const bool inside : {false, true}) {
    const PathCase c = random_case(random, inside);
    const auto ways = program(c);
    for (std::size_t i = 0; i < c.targets.size(); ++i) {
      EXPECT_EQ(ways[i].back(), pre_touch(c.geometry, c.targets[i]));
      EXPECT_EQ(ways[i + 1].front(), pre_touch(c.geometry, c.targets[i]));
      if (i > 0) {
        EXPECT_GE(c.targets[i].layer, c.targets[i - 1].layer);
      }
      const Vector3d touch =
          contact_tip(c.geometry, c.targets[i]) - pre_touch(c.geometry, c.targets[i]);
      EXPECT_NEAR(touch.norm(), c.geometry.approach_mm, 1e-12);
      EXPECT_LT((touch.normalized() - approach_direction(c.geometry, c.targets[i])).norm(), 1e-12);
    }
  }
}

TEST(Travel, EntryAndExitLieBeyondTheEndPlane) {
  core::KeyedNoise random(1, {3});
  for (const bool inside : {false, true}) {
    const PathCase c = random_case(random, inside);
    const double above =
        c.geometry.to_mm + c.geometry.tip_radius_mm + c.geometry.clearance_mm - 1e-12;
    EXPECT_GE(entry_path(c.geometry, c.targets.front()).front().z(), above);
    EXPECT_GE(exit_path(c.geometry, c.targets.front()).back().z(), above);
  }
}

TEST(Travel, GoesTheShorterWayAround) {
  const PathGeometry g = {20.0, 0.0, 50.0, false, 2.0, 3.0, 5.0, 0.0};
  const Polyline path = path_between(g, {0, 0, 350 * core::kDegree, 10.0}, {0, 1, 0.1, 10.0});
  EXPECT_EQ(path.size(), 5U);  // out, two sides of less than 15 deg, in
  for (const Vector3d& corner : path) EXPECT_GT(corner.x(), 20.0);
}

/// A part that stands where and as nobody told the planner: up to 0.3 mm and 0.2 deg off.
struct RealPart {
  cmm::PartSurface surface;
  Eigen::Isometry3d X_WS;  ///< Frame of the surface, mid-length origin, to machine.
};

RealPart real_part(core::KeyedNoise& random, const PathCase& c, const Eigen::Isometry3d& X_WP) {
  RealPart part;
  part.surface.radius_mm = c.geometry.radius_mm;
  part.surface.half_length_mm = 0.5 * (c.geometry.to_mm - c.geometry.from_mm);
  part.surface.inside = c.geometry.inside;
  part.surface.form.lobes = {{2, 0.004, 0.3, 0.5}, {3, 0.003, 1.1, -0.4}, {7, 0.002, 2.0, 0.0}};
  part.surface.form.taper_mm = 0.002;
  part.surface.form.barrel_mm = 0.003;
  part.surface.form.bend_mm = 0.004;
  const Vector3d middle(between(random, -0.3, 0.3), between(random, -0.3, 0.3),
                        0.5 * (c.geometry.to_mm + c.geometry.from_mm));
  part.X_WS = X_WP * Eigen::Translation3d(middle) *
              Eigen::AngleAxisd(between(random, 0.0, 0.2 * core::kDegree), Vector3d::UnitX());
  return part;
}

Eigen::Isometry3d random_pose(core::KeyedNoise& random) {
  const double toward = between(random, 0.0, core::kTwoPi);
  Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
  X_WP.translate(Vector3d(between(random, -200, 200), between(random, -200, 200), 100.0));
  X_WP.rotate(Eigen::AngleAxisd(between(random, 0.0, 20 * core::kDegree),
                                Vector3d(std::cos(toward), std::sin(toward), 0.0)));
  return X_WP;
}

void follow(cmm::SimulatedMachine& machine, const Eigen::Isometry3d& X_WP, const Polyline& way) {
  for (const Vector3d& corner : way) {
    const auto moved = machine.move_to(X_WP * corner);
    ASSERT_TRUE(moved) << moved.error().what;
  }
}

void run_program(cmm::SimulatedMachine& machine, const PathCase& c, const Eigen::Isometry3d& X_WP) {
  const auto sky_over = [&](const Vector3d& p_P) {
    Vector3d p = X_WP * p_P;
    p.z() = 500.0;
    return p;
  };
  const auto ways = program(c);
  ASSERT_TRUE(machine.move_to(sky_over(ways.front().front())));
  for (std::size_t i = 0; i < c.targets.size(); ++i) {
    follow(machine, X_WP, ways[i]);
    if (::testing::Test::HasFatalFailure()) return;
    const auto reading =
        machine.touch({static_cast<std::int64_t>(i), X_WP * contact_tip(c.geometry, c.targets[i]),
                       X_WP.linear() * approach_direction(c.geometry, c.targets[i]),
                       c.geometry.approach_mm, 3.0});
    ASSERT_TRUE(reading) << reading.error().what;
  }
  follow(machine, X_WP, ways.back());
  const auto up = machine.move_to(sky_over(ways.back().back()));
  ASSERT_TRUE(up) << up.error().what;
  ASSERT_TRUE(machine.home());
}

TEST(Travel, TheSimulatedMachineRunsWholeProgramsOnTiltedPartsWithoutCollision) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    core::KeyedNoise random(seed, {4});
    const PathCase c = random_case(random, seed % 2 == 1);
    if (!check_fits(c.geometry)) continue;
    const Eigen::Isometry3d X_WP = random_pose(random);
    const RealPart part = real_part(random, c, X_WP);
    cmm::SimulatedMachineOptions options;
    options.nominal_tip_radius_mm = c.geometry.tip_radius_mm;
    options.errors.repeatability_mm = 0.001;
    options.errors.tip_radius_error_mm = -0.0016;
    cmm::SimulatedMachine machine(options);
    machine.place_part(part.surface, part.X_WS);
    ASSERT_TRUE(machine.home());
    run_program(machine, c, X_WP);
    if (HasFatalFailure()) return;
  }
}

TEST(Travel, AMoveThroughTheShaftThatThePlannerAvoidsIsACollision) {
  const PathGeometry g = {20.0, 0.0, 50.0, false, 2.0, 3.0, 5.0, 0.0};
  cmm::SimulatedMachine machine({});
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
  X_WS.translation().z() = 25.0;
  machine.place_part({20.0, 25.0, false, {}}, X_WS);
  ASSERT_TRUE(machine.home());
  follow(machine, Eigen::Isometry3d::Identity(), entry_path(g, {0, 0, 0.0, 10.0}));
  const auto across = machine.move_to(pre_touch(g, {0, 1, 2.0, 10.0}));
  ASSERT_FALSE(across);
  EXPECT_EQ(across.error().code, core::Code::kCollision);
}

TEST(Travel, GoesAroundTheReferenceSphereWithoutTouchingIt) {
  const Vector3d center(300.0, 0.0, 100.0);
  const PathGeometry g = {20.0, 0.0, 50.0, false, 2.0, 3.0, 5.0, 0.0};
  for (const int points : {5, 13, 40}) {
    const auto directions = *qualification_directions(points);
    cmm::SimulatedMachine machine({});
    machine.place_references({{center, 12.5}});
    const double expected_mm = 12.5 + g.tip_radius_mm;
    ASSERT_TRUE(machine.home());
    ASSERT_TRUE(machine.move_to(center + 300.0 * Vector3d::UnitZ()));
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Vector3d& from = directions[i == 0 ? 0 : i - 1];
      const Polyline way = path_around_sphere(center, 12.5, g, from, directions[i]);
      for (const Vector3d& corner : way) ASSERT_GE(corner.z(), center.z() - 1e-9);
      follow(machine, Eigen::Isometry3d::Identity(), way);
      const auto reading =
          machine.touch({static_cast<std::int64_t>(i), center + expected_mm * directions[i],
                         -directions[i], g.approach_mm, 3.0});
      ASSERT_TRUE(reading) << reading.error().what;
      EXPECT_NEAR((reading->tip_W_mm - center).norm(), expected_mm, 2e-10) << "the grid";
    }
  }
}

TEST(Travel, GoesOverThePoleBetweenOppositePointsOfTheEquator) {
  const PathGeometry g = {20.0, 0.0, 50.0, false, 2.0, 3.0, 5.0, 0.0};
  const Polyline way =
      path_around_sphere(Vector3d::Zero(), 12.5, g, Vector3d::UnitX(), -Vector3d::UnitX());
  const auto highest = std::max_element(way.begin(), way.end(),
                                        [](const auto& a, const auto& b) { return a.z() < b.z(); });
  EXPECT_GT(highest->z(), 17.5);
}

TEST(CheckFits, RefusesABoreTooSmallForTipAndApproach) {
  const auto refused = check_fits({4.5, 0.0, 50.0, true, 2.0, 3.0, 5.0, 0.0});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kMeaning);
  EXPECT_THAT(refused.error().what, HasSubstr("bore radius of 4.5 mm"));
  EXPECT_TRUE(check_fits({5.0, 0.0, 50.0, true, 2.0, 3.0, 5.0, 0.0}));
  EXPECT_TRUE(check_fits({1.0, 0.0, 50.0, false, 2.0, 3.0, 5.0, 0.0}));
}

}  // namespace
}  // namespace rondure::plans
