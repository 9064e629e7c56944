// Planes, cones and spheres beside cylinders: their charts, and a simulated part with all of them.

#include "tests/plans/turned_part.h"

#include <cmath>
#include <string>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/noise.h"
#include "core/units.h"
#include "plans/cell/internal/hidden_errors.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/sampling.h"
#include "plans/run/runner.h"
#include "tests/plans/random_inspection.h"
#include "tests/record/sample_run.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;
using test::between;
using ::testing::HasSubstr;

TEST(SurfaceChart, OfACylinderIsWhatItWas) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    core::KeyedNoise random(seed, {1});
    const bool inside = random.uniform() < 0.5;
    const double radius = between(random, 10.0, 80.0);
    const double rho = between(random, 0.3, 4.0);
    const double approach = between(random, 1.0, 5.0);
    const Target target = {0, 0, between(random, -7.0, 7.0), between(random, -90.0, 90.0)};
    const SurfaceChart chart(radius, inside);
    const double c = std::cos(target.theta_rad);
    const double s = std::sin(target.theta_rad);
    const double contact = inside ? radius - rho : radius + rho;
    const double before = contact + (inside ? -approach : approach);
    EXPECT_EQ(chart.tip(target, rho, 0.0), Vector3d(contact * c, contact * s, target.z_mm));
    EXPECT_EQ(chart.tip(target, rho, approach), Vector3d(before * c, before * s, target.z_mm));
    const double toward = inside ? 1.0 : -1.0;
    EXPECT_EQ(chart.approach(target), Vector3d(toward * c, toward * s, 0.0));
    EXPECT_FALSE(std::signbit(chart.approach(target).z()));
  }
}

TEST(SurfaceChart, HasTheNormalOfTheSurfaceEverywhere) {
  const Plan plan = testing::turned_part();
  for (const FeaturePlan& feature : plan.features) {
    SCOPED_TRACE(feature.id);
    const SurfaceChart chart(feature);
    const auto targets = sampling_targets(feature);
    ASSERT_TRUE(targets);
    ASSERT_EQ(targets->size(), 12U);
    for (const Target& target : *targets) {
      const Vector3d n = chart.normal(target);
      EXPECT_NEAR(n.norm(), 1.0, 1e-15);
      EXPECT_EQ(chart.approach(target).dot(n), -n.squaredNorm());
      Target beside = target;
      beside.theta_rad += 1e-6;
      EXPECT_NEAR(n.dot(chart.contact_point(beside) - chart.contact_point(target)), 0.0, 1e-10);
      beside = target;
      beside.z_mm += feature.type == record::Shape::kPlane ? 0.0 : 1e-6;
      EXPECT_NEAR(n.dot(chart.contact_point(beside) - chart.contact_point(target)), 0.0, 1e-12);
    }
  }
}

TEST(SurfaceChart, LaysTheCirclesOfAPlaneFromInsideOutwards) {
  FeaturePlan face = testing::turned_part().features[2];
  face.sampling.layers = 3;
  const auto radius = [&](int layer) {
    return SurfaceChart(face).contact_point({layer, 0, 1.0, 0.0}).head<2>().norm();
  };
  EXPECT_NEAR(radius(0), 20.0, 1e-12);
  EXPECT_NEAR(radius(1), 22.5, 1e-12);
  EXPECT_NEAR(radius(2), 25.0, 1e-12);
  face.sampling.layers = 1;
  EXPECT_NEAR(radius(0), 22.5, 1e-12) << "a single circle is in the middle";
  face.nominal.faces = record::Faces::kDown;
  EXPECT_EQ(SurfaceChart(face).approach({}), Vector3d(Vector3d::UnitZ()));
}

/// Tip centre in the frame of the part, which an ideal machine and fixture leave in its place.
Vector3d in_part(const Plan& plan, const Vector3d& tip_W_mm) {
  const Eigen::Isometry3d X_WP =
      fixture::body_to_machine(nominal_kinematics(*plan.fixture), core::Pose{}) *
      nominal_seat(*plan.fixture);
  return X_WP.inverse() * tip_W_mm;
}

TEST(SimulatedPart, IsTouchedOnAllItsSurfacesInOneClamping) {
  Plan plan = testing::turned_part();
  record::CharacteristicTask asked;
  asked.id = "CYLt";
  asked.form = record::Form::kCylindricity;
  plan.features[1].characteristics.push_back(asked);
  const record::Scratch scratch;
  const auto done = run_plan(plan, testing::options_for(scratch / "run"));
  ASSERT_TRUE(done) << done.error().what;
  ASSERT_FALSE(done->failure) << done->failure->what;
  const record::RunRecord run = testing::journal_of(scratch / "run");
  ASSERT_EQ(run.ending, "finished");
  ASSERT_EQ(run.poses.size(), plan.features.size());
  for (const record::PoseVisit& pose : run.poses) {
    EXPECT_EQ(pose.reached, run.poses.front().reached);
    EXPECT_TRUE(pose.final_cloud);
  }
  EXPECT_EQ(run.features[2].strategy, record::Strategy::kStartPose);
  constexpr double kRho = 2.0;
  int measured = 0;
  for (const record::Touch& touch : run.touches) {
    if (touch.purpose != record::Touch::Purpose::kMeasure) continue;
    ++measured;
    const Vector3d p = in_part(plan, touch.tip_mm);
    const double r = p.head<2>().norm();
    const double theta = std::atan2(p.y(), p.x());
    SCOPED_TRACE(p.transpose());
    switch (run.poses[static_cast<std::size_t>(touch.pose)].feature) {
      case 0:
        EXPECT_NEAR(r, 15.0 + kRho, 1e-9);
        break;
      case 1: {  // V1 with half the radius: its own axis leans, on it 2 lobes and a taper
        const Vector3d axis = Vector3d(20e-6, -40e-6, 1.0).normalized();
        const Vector3d w = p - Vector3d(4.8e-3, 3.1e-3, 15.0);
        const Vector3d radial = w - w.dot(axis) * axis;
        const double wanted =
            15.0 + kRho + 1.6e-3 * std::cos(2.0 * theta - 0.2) + 3e-3 * w.dot(axis) / 15.0;
        EXPECT_NEAR(radial.norm(), wanted, 2e-6);
        break;
      }
      case 2: {
        const double t = r / 30.0;
        const double h = 0.0021 * t * std::cos(theta - 0.9) - 0.0042 * t * t +
                         0.0012 * t * t * std::cos(2.0 * theta);
        EXPECT_NEAR(p.z(), h + kRho, 1e-6);
        break;
      }
      case 3: {
        const double phi = -10.0 * core::kDegree;
        EXPECT_NEAR(r * std::cos(phi) - (p.z() - 30.0) * std::sin(phi), 15.0 * std::cos(phi) + kRho,
                    1e-9);
        break;
      }
      default:
        EXPECT_NEAR((p - Vector3d(0.0, 0.0, 62.0)).norm(), 15.0 + kRho, 1e-9);
    }
  }
  EXPECT_EQ(measured, 60);
}

TEST(SimulatedPart, StaysOneSurfaceWhereThePlanHasCylindersWithoutAPlaceOfTheirOwn) {
  Plan plan = testing::turned_part();
  EXPECT_TRUE(has_whole_part(plan));
  plan.features.resize(2);
  EXPECT_TRUE(has_whole_part(plan));
  plan.simulation->features.clear();
  EXPECT_FALSE(has_whole_part(plan));
}

TEST(SimulatedPart, HasAFaceInThePlaceOfTheFlatEndInItsPlane) {
  Plan plan = testing::turned_part();
  FeaturePlan flange = plan.features[0];
  flange.id = "flange";
  flange.nominal = {60.0, -10.0, 0.0};
  plan.features.push_back(flange);
  const auto part = simulated_part(plan.features, *plan.simulation, plan.features[2]);
  ASSERT_EQ(part.surfaces.size(), 6U);
  const auto& side = std::get<cmm::PartSurface>(part.surfaces.back().surface);
  EXPECT_FALSE(side.upper_end);
  EXPECT_TRUE(side.lower_end);
  EXPECT_EQ(simulated_part(plan.features, *plan.simulation, flange).surfaces.size(), 6U);
  plan.features.back().side = record::Side::kInside;
  EXPECT_EQ(simulated_part(plan.features, *plan.simulation, plan.features.back()).surfaces.size(),
            1U)
      << "a bore is a block of its own";
  EXPECT_EQ(simulated_part(plan.features, *plan.simulation, plan.features[2]).surfaces.size(), 5U);
}

/// The problems of an example plan whose feature and simulation are changed.
std::string problems(const nlohmann::json& feature, const nlohmann::json& simulated = {}) {
  auto plan = nlohmann::json::parse(testing::bytes_of(testing::example("08_shaft_scanned.json")));
  nlohmann::json& seat = plan["features"][0];
  seat.erase("characteristics");
  seat.erase("nominal");
  seat["sampling"] = {{"layers", 2}, {"points_per_layer", 6}, {"margin_mm", 5}};
  seat["pose_search"] = {{"strategy", "start-pose"}};
  seat.merge_patch(feature);
  if (!simulated.is_null()) plan["simulation"]["features"] = nlohmann::json::array({simulated});
  return testing::lines_of(parse_plan(plan.dump(), {}, "plan"));
}

const nlohmann::json kFace = {
    {"type", "plane"},
    {"nominal", {{"z_mm", 0}, {"faces", "up"}, {"from_diameter_mm", 20}, {"to_diameter_mm", 80}}}};

nlohmann::json with(nlohmann::json feature, const nlohmann::json& patch) {
  feature.merge_patch(patch);
  return feature;
}

TEST(TurnedPlan, OfAFaceIsAccepted) {
  EXPECT_EQ(problems(kFace), "");
  EXPECT_EQ(problems(kFace, {{"id", "seat"}, {"saucer_um", -4}}), "");
}

TEST(TurnedPlan, SaysWhatAFaceLacksAndDoesNotTake) {
  EXPECT_THAT(problems(with(kFace, {{"nominal", {{"to_diameter_mm", nullptr}}}})),
              HasSubstr("the outer diameter of the ring"));
  EXPECT_THAT(problems(with(kFace, {{"nominal", {{"faces", nullptr}}}})),
              HasSubstr("the side of the plane that is free to touch"));
  EXPECT_THAT(problems(with(kFace, {{"nominal", {{"diameter_mm", 50}}}})),
              HasSubstr("a plane has no diameter_mm"));
  EXPECT_THAT(problems(with(kFace, {{"nominal", {{"from_diameter_mm", 90}}}})),
              HasSubstr("the inner diameter 90 mm is not below the outer diameter 80 mm"));
  EXPECT_THAT(problems(with(kFace, {{"sampling", {{"margin_mm", 15}}}})),
              HasSubstr("leave nothing of a surface 30 mm long"));
  EXPECT_THAT(problems(with(kFace, {{"sampling", {{"method", "scan"}}}})),
              HasSubstr("a plane is touched, not scanned"));
  EXPECT_THAT(problems(with(kFace, {{"side", "inside"}})), HasSubstr("a plane has no inside"));
}

TEST(TurnedPlan, RefusesConesAndSpheresThatCannotBe) {
  const nlohmann::json cone = {
      {"type", "cone"},
      {"nominal", {{"diameter_mm", 40}, {"from_mm", -20}, {"to_mm", 20}, {"half_angle_deg", 10}}}};
  EXPECT_EQ(problems(cone), "");
  EXPECT_THAT(problems(with(cone, {{"nominal", {{"half_angle_deg", 0.01}}}})),
              HasSubstr("a half angle of 0.01 deg is below 0.05 deg"));
  EXPECT_THAT(problems(with(cone, {{"nominal", {{"half_angle_deg", -30}}}})),
              HasSubstr("comes to its apex below its upper end"));
  EXPECT_THAT(problems(with(cone, {{"side", "inside"}})),
              HasSubstr("the machine touches a cone only outside"));
  EXPECT_THAT(problems(with(cone, {{"sampling", {{"layers", 1}}}})),
              HasSubstr("leaves the tilt of the cone undetermined"));
  const nlohmann::json ball = {{"type", "sphere"},
                               {"nominal", {{"diameter_mm", 40}, {"from_mm", -5}, {"to_mm", 15}}}};
  EXPECT_EQ(problems(ball), "");
  EXPECT_THAT(problems(with(ball, {{"nominal", {{"center_mm", {0, 0, -6}}}}})),
              HasSubstr("go beyond a sphere of 40 mm about z = -6 mm"));
}

TEST(TurnedPlan, KnowsTheSurfacesOfTheSimulatedPart) {
  EXPECT_THAT(problems(kFace, {{"id", "neck"}}), HasSubstr("no touched feature has the id"));
  EXPECT_THAT(problems(kFace, {{"id", "seat"}, {"taper_um", 2}}),
              HasSubstr("it is no form of a plane"));
}

}  // namespace
}  // namespace rondure::plans
