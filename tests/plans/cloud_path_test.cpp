// The oracle of clearance: every sampled place of ball, shaft and holder on the way against closed
// distances of the solids, written here once more.

#include "plans/path/internal/cloud_path.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/checks/internal/reach_advice.h"
#include "plans/path/internal/nominal_geometry.h"
#include "tests/plans/random_inspection.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using test::between;
using ::testing::AllOf;
using ::testing::HasSubstr;

Plan plain_plan() {
  Plan plan;
  plan.part.location_uncertainty_mm = 0.0;
  plan.machine.emplace();
  plan.fixture.emplace();
  plan.fixture->axis_point_mm = {0.0, 0.0, 150.0};
  plan.probe.emplace();
  plan.probe->qualification.sphere_center_mm = {400.0, 0.0, 100.0};
  FeaturePlan feature;
  feature.id = "surface";
  feature.nominal = {50.0, -40.0, 40.0};
  plan.features.push_back(feature);
  return plan;
}

Plan random_plan(core::KeyedNoise& random) {
  Plan plan = plain_plan();
  FeaturePlan& f = plan.features.front();
  f.side = random.uniform() < 0.3 ? record::Side::kInside : record::Side::kOutside;
  f.nominal.diameter_mm = between(random, 24.0, 90.0);
  f.nominal.to_mm = f.nominal.from_mm + between(random, 40.0, 100.0);
  f.sampling.layers = 2 + static_cast<int>(between(random, 0.0, 3.0));
  f.sampling.points_per_layer = 3 + static_cast<int>(between(random, 0.0, 5.0));
  plan.machine->clearance_mm = between(random, 2.0, 7.0);
  plan.machine->approach_mm = between(random, 1.5, 4.0);
  plan.fixture->rim_height_mm = between(random, 0.0, 90.0);
  plan.fixture->rim_diameter_mm = random.uniform() < 0.5 ? between(random, 200.0, 400.0) : 0.0;
  plan.fixture->table_height_mm = -50.0;
  plan.fixture->clamp_from_mm = f.nominal.from_mm - 25.0;
  plan.fixture->clamp_to_mm = f.nominal.from_mm - 5.0;
  plan.fixture->ring_diameter_mm = f.nominal.diameter_mm + between(random, 20.0, 80.0);
  plan.probe->tip_diameter_mm = between(random, 3.0, 8.0);
  if (random.uniform() < 0.8) {
    plan.probe->stylus_length_mm = between(random, 30.0, 120.0);
    plan.probe->stylus_diameter_mm = between(random, 0.3, 0.7) * plan.probe->tip_diameter_mm;
    plan.probe->holder_diameter_mm = between(random, 8.0, 25.0);
  }
  if (random.uniform() < 0.3 && f.side == record::Side::kOutside) {
    plan.part.sections.push_back({f.nominal.to_mm, f.nominal.to_mm + between(random, 5.0, 30.0),
                                  between(random, 0.6, 1.05) * f.nominal.diameter_mm, 0.0});
  }
  return plan;
}

/// Spheres on the ring and on the base, near the part.
void add_spheres(core::KeyedNoise& random, Plan& plan) {
  const double radius_mm = 0.5 * plan.features.front().nominal.diameter_mm;
  const auto beside = [&](double from_mm) {
    const double turn = between(random, 0.0, core::kTwoPi);
    const double away_mm = radius_mm + between(random, from_mm, 90.0);
    return std::array{away_mm * std::cos(turn), away_mm * std::sin(turn),
                      between(random, -60.0, 50.0)};
  };
  plan.fixture->reached_pose.emplace().spheres = {{beside(15.0)}, {beside(15.0)}};
  plan.fixture->datum.emplace().spheres = {{beside(40.0)}};
  plan.fixture->datum->spheres.front().center_mm[2] += plan.fixture->axis_point_mm[2];
}

/// Distance from the rectangle [r0, r1] x [z0, z1] turned about z.
double from_solid(const Vector3d& p, double r0, double r1, double z0, double z1) {
  const double r = p.head<2>().norm();
  const double dr = std::max({r0 - r, 0.0, r - r1});
  const double dz = std::max({z0 - p.z(), 0.0, p.z() - z1});
  return std::sqrt(dr * dr + dz * dz);
}

/// Distance of a place outside a frustum: to its ends, or to the foot on its wall.
double from_cone(const Vector3d& p, const NominalPlan& n) {
  const double slope = std::tan(n.half_angle_deg * core::kDegree);
  const auto radius = [&](double z) { return 0.5 * n.diameter_mm + (z - n.from_mm) * slope; };
  const double r = p.head<2>().norm();
  const double off_wall = r - radius(p.z());  // along the radius
  const double foot_z =
      std::clamp(p.z() + off_wall * slope / (1.0 + slope * slope), n.from_mm, n.to_mm);
  if (off_wall <= 0.0 && p.z() >= n.from_mm && p.z() <= n.to_mm) return 0.0;
  return std::min({std::hypot(r - radius(foot_z), p.z() - foot_z),
                   from_solid(p, 0.0, radius(n.from_mm), n.from_mm, n.from_mm),
                   from_solid(p, 0.0, radius(n.to_mm), n.to_mm, n.to_mm)});
}

/// Distance of a place from the part, and from everything else.
struct Distances {
  double part_mm;
  double rest_mm;
};

Distances distances(const Plan& plan, const Placement& placement, const Vector3d& p_W) {
  const FeaturePlan& f = plan.features.front();
  const FixturePlan& x = *plan.fixture;
  const Vector3d p = placement.X_WP.inverse() * p_W;
  const double radius = 0.5 * f.nominal.diameter_mm;
  const bool bore = f.side == record::Side::kInside;
  Distances out{};
  if (f.type == record::Shape::kPlane) {
    out.part_mm = from_solid(p, 0.5 * f.nominal.from_diameter_mm, 0.5 * f.nominal.to_diameter_mm,
                             f.nominal.z_mm, f.nominal.z_mm);
  } else if (f.type == record::Shape::kSphere) {
    out.part_mm = std::max(0.0, (p - vector3(f.nominal.center_mm)).norm() - radius);
  } else if (f.type == record::Shape::kCone) {
    out.part_mm = from_cone(p, f.nominal);
  } else {
    out.part_mm = from_solid(p, bore ? radius : 0.0, bore ? radius + 20.0 : radius,
                             f.nominal.from_mm, f.nominal.to_mm);
  }
  for (const SectionPlan& s : plan.part.sections) {
    out.part_mm =
        std::min(out.part_mm, from_solid(p, 0.0, 0.5 * s.diameter_mm, s.from_mm, s.to_mm));
  }
  const double ring = x.ring_diameter_mm > 0.0
                          ? from_solid(placement.X_WN.inverse() * p_W, bore ? radius : 0.0,
                                       0.5 * x.ring_diameter_mm, x.clamp_from_mm, x.clamp_to_mm)
                          : 1e9;
  const double rim_r = x.rim_diameter_mm > 0.0 ? 0.5 * x.rim_diameter_mm : 1e6;
  const double rim = from_solid(p_W, 0.0, rim_r, -1e6, x.rim_height_mm);
  const Vector3d to_sphere = p_W - vector3(plan.probe->qualification.sphere_center_mm);
  const double sphere_r = 0.5 * plan.probe->qualification.sphere_diameter_mm;
  out.rest_mm = std::min({ring, rim, p_W.z() - x.table_height_mm, to_sphere.norm() - sphere_r,
                          from_solid(to_sphere, 0.0, sphere_r / 3.0, -1e6, 0.0)});
  const auto away_from = [&](const Vector3d& center_W, double diameter_mm) {
    out.rest_mm = std::min(out.rest_mm, (p_W - center_W).norm() - 0.5 * diameter_mm);
  };
  if (x.datum) {
    for (const auto& sphere : x.datum->spheres)
      away_from(vector3(sphere.center_mm), x.datum->sphere_diameter_mm);
  }
  if (x.reached_pose) {
    for (const auto& sphere : x.reached_pose->spheres)
      away_from(placement.X_WN * vector3(sphere.center_mm), x.reached_pose->sphere_diameter_mm);
  }
  return out;
}

struct Needs {
  double ball_part_mm;
  double shaft_part_mm;
  double rest_mm;
};

/// Every tenth of a way, every 2 mm of the tool.
void expect_clear(const Plan& plan, const Placement& placement, const Vector3d& a,
                  const Vector3d& b, const Needs& needs) {
  const ProbePlan& probe = *plan.probe;
  for (int i = 0; i <= 10; ++i) {
    const Vector3d tip = a + (b - a) * i / 10.0;
    const Distances ball = distances(plan, placement, tip);
    const double rho = 0.5 * probe.tip_diameter_mm;
    ASSERT_GE(ball.part_mm, rho + needs.ball_part_mm - 1e-5);
    ASSERT_GE(ball.rest_mm, rho + needs.rest_mm - 1e-5);
    if (probe.stylus_length_mm <= 0.0) continue;
    for (double up = 0.0; up < probe.stylus_length_mm + 100.0; up += 2.0) {
      const bool shaft = up < probe.stylus_length_mm;
      const double r = 0.5 * (shaft ? probe.stylus_diameter_mm : probe.holder_diameter_mm);
      const Distances d = distances(plan, placement, tip + up * Vector3d::UnitZ());
      ASSERT_GE(d.part_mm, r + needs.shaft_part_mm - 1e-5) << (shaft ? "shaft" : "holder");
      ASSERT_GE(d.rest_mm, r + needs.rest_mm - 1e-5) << (shaft ? "shaft" : "holder");
    }
  }
}

void expect_whole_path_clear(const Plan& plan, const CloudPath& path, const PathGeometry& geometry,
                             const Placement& placement) {
  const double clearance = plan.machine->clearance_mm;
  const double near = std::min(plan.machine->approach_mm, clearance);
  std::vector<Polyline> ways;
  for (std::size_t k = 0; k < path.order().size(); ++k) ways.push_back(path.way_W(k));
  ways.push_back(path.exit_W(path.order().size() - 1));
  for (const Polyline& way : ways) {
    for (std::size_t i = 1; i < way.size(); ++i) {
      expect_clear(plan, placement, way[i - 1], way[i], {near, near, clearance});
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  for (std::size_t k = 0; k < path.order().size(); ++k) {
    const Vector3d contact = placement.X_WP * contact_tip(geometry, path.target(k));
    expect_clear(plan, placement, path.way_W(k).back(), contact, {0.0, kTouchGap_mm, clearance});
    if (::testing::Test::HasFatalFailure()) return;
  }
}

Placement random_placement(core::KeyedNoise& random, const Plan& plan) {
  const double tilt = random.uniform() < 0.5 ? 0.0 : between(random, 0.0, 12.0);
  const core::Pose pose{tilt * core::kDegree, between(random, -tilt, tilt) * core::kDegree};
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(nominal_kinematics(*plan.fixture), pose);
  return {X_WB * nominal_seat(*plan.fixture), X_WB * nominal_seat(*plan.fixture)};
}

TEST(CloudPath, KeepsBallShaftAndHolderClearOfEverythingInRandomCells) {
  int reached = 0;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {3});
    Plan plan = random_plan(random);
    if (seed % 2 == 1) add_spheres(random, plan);
    const FeaturePlan& feature = plan.features.front();
    const PathGeometry geometry = path_geometry(plan, feature, 0.0);
    if (!check_fits(geometry)) continue;
    const Placement placement = random_placement(random, plan);
    const Scene scene(plan, feature);
    const auto targets = *sampling_targets(feature);
    const CloudPath path(scene, placement, geometry, 500.0, targets,
                         short_tour(targets, bare_cost(targets, geometry)));
    if (!path.unreachable().empty()) {
      ++refused;
      continue;
    }
    ++reached;
    expect_whole_path_clear(plan, path, geometry, placement);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(reached, 10);
  EXPECT_GT(refused, 5);
}

/// A random cell with a face between a flange and a shaft, a cone or a ball in place of its
/// surface.
Plan random_turned_plan(core::KeyedNoise& random, record::Shape type) {
  Plan plan = random_plan(random);
  FeaturePlan& f = plan.features.front();
  f.type = type;
  f.side = record::Side::kOutside;
  f.sampling.margin_mm = between(random, 6.0, 14.0);
  plan.part.sections.clear();
  NominalPlan n;
  if (type == record::Shape::kPlane) {
    const double shaft = between(random, 10.0, 40.0);
    n.faces = random.uniform() < 0.7 ? record::Faces::kUp : record::Faces::kDown;
    n.from_diameter_mm = shaft;
    n.to_diameter_mm = shaft + between(random, 70.0, 100.0);
    n.z_mm = between(random, -20.0, 40.0);
    const double up = n.faces == record::Faces::kUp ? 1.0 : -1.0;
    const double shaft_end = n.z_mm + up * between(random, 5.0, 50.0);
    const double flange_end = n.z_mm - up * between(random, 5.0, 20.0);
    plan.part.sections.push_back(
        {std::min(n.z_mm, shaft_end), std::max(n.z_mm, shaft_end), shaft, 0.0});
    plan.part.sections.push_back(
        {std::min(n.z_mm, flange_end), std::max(n.z_mm, flange_end), n.to_diameter_mm, 0.0});
  } else if (type == record::Shape::kCone) {
    n = {between(random, 20.0, 60.0), -40.0, 20.0};
    n.half_angle_deg = between(random, -9.0, 40.0);
  } else {
    n = {between(random, 50.0, 80.0), -10.0, 24.0};
    n.center_mm = {between(random, -3.0, 3.0), 0.0, between(random, 0.0, 14.0)};
  }
  f.nominal = n;
  return plan;
}

/// Paths in random cells are clear, or the cell is refused.
void expect_turned_paths_clear(record::Shape type, int least_reached) {
  int reached = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {5});
    const Plan plan = random_turned_plan(random, type);
    const FeaturePlan& feature = plan.features.front();
    const PathGeometry geometry = path_geometry(plan, feature, 0.0);
    const Placement placement = random_placement(random, plan);
    const Scene scene(plan, feature);
    const auto targets = *sampling_targets(feature);
    const CloudPath path(scene, placement, geometry, 500.0, targets,
                         short_tour(targets, bare_cost(targets, geometry)));
    if (!path.unreachable().empty()) continue;
    ++reached;
    expect_whole_path_clear(plan, path, geometry, placement);
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GE(reached, least_reached);
}

TEST(FacePath, MeetsNoShoulder) { expect_turned_paths_clear(record::Shape::kPlane, 10); }
TEST(ConePath, KeepsBallShaftAndHolderClear) {
  expect_turned_paths_clear(record::Shape::kCone, 10);
}
TEST(SpherePath, KeepsBallShaftAndHolderClear) {
  expect_turned_paths_clear(record::Shape::kSphere, 10);
}

TEST(FacePath, IsRefusedWhereAShaftRisesBesideTheTouch) {
  Plan plan = plain_plan();
  FeaturePlan& face = plan.features.front();
  face.type = record::Shape::kPlane;
  face.nominal = {};
  face.nominal.from_diameter_mm = 30.0;
  face.nominal.to_diameter_mm = 60.0;
  face.nominal.faces = record::Faces::kUp;
  face.sampling = {2, 6, 5.0, 0.0, 1.0};
  const auto refused = [&] {
    return reachable_targets(plan, 0) ? std::string() : reachable_targets(plan, 0).error().what;
  };
  EXPECT_EQ(refused(), "");
  plan.part.sections.push_back({0.0, 50.0, 30.0, 0.0});
  EXPECT_EQ(refused(), "") << "the inner circle is 3 mm from the shaft, as much as the approach";
  plan.part.sections.back().diameter_mm = 31.0;
  EXPECT_THAT(refused(), AllOf(HasSubstr("the ball"), HasSubstr("to a shoulder of the part")));
  face.nominal.faces = record::Faces::kDown;
  EXPECT_EQ(refused(), "") << "it rises from the other side";
  plan.part.sections.back() = {-50.0, 0.0, 30.0, 0.0};
  EXPECT_EQ(refused(), "");
  plan.probe->stylus_length_mm = 60.0;
  plan.probe->stylus_diameter_mm = 2.0;
  EXPECT_THAT(refused(), HasSubstr("the shaft of the stylus"));
}

TEST(CloudPath, IsNeverLongerThanInTheOrderOfTheTargets) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise random(seed, {3});
    const Plan plan = random_plan(random);
    const FeaturePlan& feature = plan.features.front();
    const PathGeometry geometry = path_geometry(plan, feature, 0.0);
    if (!check_fits(geometry)) continue;
    const Placement placement = random_placement(random, plan);
    const Scene scene(plan, feature);
    const auto targets = *sampling_targets(feature);
    std::vector<std::size_t> own;
    for (std::size_t i = 0; i < targets.size(); ++i) own.push_back(i);
    const CloudPath plainly(scene, placement, geometry, 500.0, targets, own);
    const CloudPath path(scene, placement, geometry, 500.0, targets,
                         short_tour(targets, bare_cost(targets, geometry)));
    if (!path.unreachable().empty()) continue;
    const auto length = [](const CloudPath& p) {
      double sum = length_mm(p.exit_W(p.order().size() - 1));
      for (std::size_t k = 0; k < p.order().size(); ++k) sum += length_mm(p.way_W(k));
      return sum;
    };
    EXPECT_LE(length(path), length(plainly) + 1e-9);
  }
}

/// Why the start pose of a plan cannot be measured, and what would help.
std::string refusal(const Plan& plan) {
  const auto targets = reachable_targets(plan, 0);
  return targets ? "everything is reached" : targets.error().what;
}

TEST(Reach, NamesTheRimAndTheMarginThatWouldDo) {
  Plan plan = plain_plan();
  plan.fixture->rim_height_mm = 108.0;  // the lowest layer lies at 115
  plan.fixture->max_alpha_deg = plan.fixture->max_beta_deg = 10.0;
  plan.fixture->min_alpha_deg = plan.fixture->min_beta_deg = -10.0;
  EXPECT_EQ(refusal(plan), "everything is reached");
  plan.fixture->rim_height_mm = 108.5;
  EXPECT_EQ(refusal(plan),
            "layer 1, point 1 (0.0 deg): the ball of the stylus would come nearer than 5 mm "
            "(machine.clearance_mm) to the rim of the bowl on the way to machine (27.000, 0.000, "
            "115.000) mm; nor can layer 1 "
            "point 2, 3, 4, 5, 6, 7 be reached; to reach all of them: give a margin of 6 mm "
            "(margin_mm)");
}

TEST(Reach, NamesTheTable) {
  Plan plan = plain_plan();
  plan.fixture->table_height_mm = 110.0;
  EXPECT_THAT(refusal(plan), AllOf(HasSubstr("layer 1, point 1"), HasSubstr("to the table")));
}

TEST(Reach, NamesTheReferenceSphereAndItsStem) {
  Plan plan = plain_plan();
  plan.probe->qualification.sphere_center_mm = {45.0, 0.0, 150.0};
  EXPECT_THAT(refusal(plan), HasSubstr("to a reference sphere"));
  plan.probe->qualification.sphere_center_mm = {45.0, 0.0, 220.0};
  plan.probe->qualification.sphere_diameter_mm = 10.0;
  plan.probe->qualification.stem_diameter_mm = 20.0;
  EXPECT_THAT(refusal(plan), HasSubstr("to the stem of the reference sphere"));
}

TEST(Reach, NamesTheRingThatTheHolderOrTheBallMeets) {
  Plan plan = plain_plan();
  plan.fixture->clamp_from_mm = -70.0;
  plan.fixture->clamp_to_mm = -45.0;
  EXPECT_EQ(refusal(plan), "everything is reached");
  plan.fixture->clamp_to_mm = -40.0;
  EXPECT_THAT(refusal(plan), HasSubstr("where the clamp, the tip and the clearance end"))
      << "a ring of unknown size";
  plan.fixture->ring_diameter_mm = 90.0;
  EXPECT_THAT(refusal(plan), AllOf(HasSubstr("ball"), HasSubstr("to the clamping ring"),
                                   HasSubstr("give a margin of 7 mm")));
}

TEST(Reach, PassesARingOfKnownSizeToTargetsBelowIt) {
  Plan plan = plain_plan();
  plan.features.front().nominal = {50.0, -40.0, 10.0};
  plan.features.front().sampling = {2, 5, 5.0, 0.0, 1.0};
  plan.fixture->clamp_from_mm = 30.0;
  plan.fixture->clamp_to_mm = 40.0;
  EXPECT_THAT(refusal(plan), HasSubstr("where the clamp"));
  plan.fixture->ring_diameter_mm = 60.0;
  EXPECT_EQ(refusal(plan), "everything is reached");
}

TEST(Reach, NamesTheShaftUnderALeaningPartAndThePoseThatWouldDo) {
  Plan plan = plain_plan();
  plan.probe->stylus_length_mm = 100.0;
  plan.probe->stylus_diameter_mm = 2.0;
  EXPECT_EQ(refusal(plan), "everything is reached");
  plan.features.front().pose_search.start_alpha_deg = 15.0;
  EXPECT_THAT(refusal(plan),
              AllOf(HasSubstr("the shaft of the stylus would come nearer than 0.25 mm to the part"),
                    HasSubstr("turn it to (0, 0) deg (start_alpha_deg, start_beta_deg)")));
}

TEST(Reach, NamesTheShoulderAboveTheSurface) {
  Plan plan = plain_plan();
  plan.part.sections.push_back({40.0, 60.0, 80.0, 0.0});
  EXPECT_EQ(refusal(plan), "everything is reached") << "a bare ball goes around the shoulder";
  plan.probe->stylus_length_mm = 150.0;
  plan.probe->stylus_diameter_mm = 2.0;
  EXPECT_THAT(refusal(plan),
              AllOf(HasSubstr("the shaft of the stylus"), HasSubstr("to a shoulder of the part")));
}

TEST(Reach, NamesTheHolderAndTheLengthThatWouldDo) {
  Plan plan = plain_plan();
  plan.probe->stylus_length_mm = 40.0;
  plan.probe->stylus_diameter_mm = 2.0;
  plan.probe->holder_diameter_mm = 20.0;
  const std::string words = refusal(plan);
  EXPECT_THAT(words, AllOf(HasSubstr("the holder of the stylus"), HasSubstr("to the part"),
                           HasSubstr("take a stylus of 90 mm (stylus_length_mm)")));
  plan.probe->stylus_length_mm = 90.0;
  EXPECT_EQ(refusal(plan), "everything is reached");
}

TEST(Reach, NamesTheEndOfTheMachine) {
  Plan plan = plain_plan();
  plan.machine->volume_min_mm = {-30.0, -200.0, 0.0};
  plan.machine->volume_max_mm = {200.0, 200.0, 600.0};
  EXPECT_THAT(refusal(plan), AllOf(HasSubstr("layer 2, point 4 (167.1 deg)"),
                                   HasSubstr("leave the volume of the machine")));
}

TEST(Reach, SaysThatNothingHelpsWhenNothingDoes) {
  Plan plan = plain_plan();
  plan.fixture->table_height_mm = 200.0;
  EXPECT_THAT(refusal(plan),
              HasSubstr("no other pose, stylus or margin that was tried reaches it"));
}

TEST(Bore, IsEnteredAlongItsAxisAndLeftTheSameWay) {
  Plan plan = plain_plan();
  plan.features.front().side = record::Side::kInside;
  plan.probe->stylus_length_mm = 120.0;
  plan.probe->stylus_diameter_mm = 2.0;
  const auto targets = *sampling_targets(plan.features.front());
  const PathGeometry geometry = path_geometry(plan, plan.features.front(), 0.0);
  FeaturePlanner planner(plan, plan.features.front());
  const Eigen::Isometry3d X_WB =
      fixture::body_to_machine(nominal_kinematics(*plan.fixture), core::Pose{});
  const auto path = planner.lay(targets, geometry, X_WB, nominal_seat(*plan.fixture));
  ASSERT_TRUE(path) << path.error().what;
  const Polyline in = path->entry_W(0);
  ASSERT_EQ(in.size(), 4U);
  for (std::size_t i = 0; i + 1 < in.size(); ++i) EXPECT_LT(in[i].head<2>().norm(), 1e-12);
  EXPECT_EQ(path->exit_W(0).front(), in.back());
}

}  // namespace
}  // namespace rondure::plans
