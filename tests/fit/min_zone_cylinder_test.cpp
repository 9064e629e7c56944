#include "fit/references/min_zone.h"

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/least_squares/cylinder.h"
#include "fit/references/one_sided.h"
#include "fit/zone/fit.h"
#include "tests/fit/spec_cases.h"

namespace rondure::fit {
namespace {

using Points3 = std::vector<Eigen::Vector3d>;

Eigen::Isometry3d random_place(std::uint64_t seed, double far_mm) {
  core::KeyedNoise noise(seed, {4});
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.rotate(Eigen::Quaterniond(noise.normal(), noise.normal(), noise.normal(), noise.normal())
                   .normalized());
  place.pretranslate(far_mm * Eigen::Vector3d(noise.normal(), noise.normal(), noise.normal()));
  return place;
}

/// Checks by hand what the multipliers claim: non-negative, sum 1 on each side, on contacts only,
/// gradients in balance. Gradients by finite differences: shares nothing with the solver.
void expect_stationary(const Points3& points, const MinZoneCylinder& zone) {
  const Eigen::Vector3d u = zone.axis.direction.unitOrthogonal();
  const Eigen::Vector3d v = zone.axis.direction.cross(u);
  const double h = 1e-6;
  const auto moved = [&](int k, double by) {
    Axis axis = zone.axis;
    const Eigen::Vector3d& side = k % 2 == 0 ? u : v;
    if (k < 2) axis.point_mm += by * side;
    if (k >= 2) axis.direction = (axis.direction + by * side / 35.0).normalized();
    return axis;
  };
  Eigen::Vector4d balance = Eigen::Vector4d::Zero();
  const auto add = [&](const std::vector<Contact>& side, double radius, double sign) {
    double sum = 0.0;
    for (const Contact& c : side) {
      EXPECT_GT(c.multiplier, 0.0);
      EXPECT_NEAR(distance_mm(zone.axis, points[c.index]), radius, 1e-11);
      sum += c.multiplier;
      for (int k = 0; k < 4; ++k) {
        balance(k) += sign * c.multiplier *
                      (distance_mm(moved(k, h), points[c.index]) -
                       distance_mm(moved(k, -h), points[c.index])) /
                      (2.0 * h);
      }
    }
    EXPECT_NEAR(sum, 1.0, 1e-12);
  };
  add(zone.outer, zone.outer_radius_mm, 1.0);
  add(zone.inner, zone.inner_radius_mm, -1.0);
  EXPECT_LT(balance.cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(test::zone_about(points, zone.axis), zone.width_mm(), 1e-12);
}

TEST(MinZoneCylinder, CarriesMultipliersThatProveItStationary) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = test::random_cylinder(
        seed, 3, {3 + static_cast<int>(seed % 3), 5 + static_cast<int>(seed % 4)});
    const auto zone = min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(zone.has_value());
    EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kLocal) << zone->certificate.reason;
    EXPECT_LE(zone->certificate.gap_mm, 1e-10 * zone->width_mm());
    EXPECT_LE(zone->width_mm(),
              ls_cylinder(points, Eigen::Vector3d::UnitZ())->deviation_mm + 1e-13);
    expect_stationary(points, *zone);
  }
}

TEST(MinZoneCylinder, IsNotBeatenByRandomAxesNearby) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = test::random_cylinder(seed, 3, {});
    const auto zone = min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(zone.has_value());
    core::KeyedNoise noise(seed, {5});
    for (int k = 0; k < 4000; ++k) {
      const double size = 0.01 * std::pow(10.0, -6.0 * noise.uniform());
      Axis axis = zone->axis;
      axis.point_mm += size * Eigen::Vector3d(noise.normal(), noise.normal(), 0.0);
      axis.direction += size / 35.0 * Eigen::Vector3d(noise.normal(), noise.normal(), 0.0);
      axis.direction.normalize();
      ASSERT_GE(test::zone_about(points, axis), zone->width_mm() - 1e-13);
    }
  }
}

TEST(MinZoneCylinder, DoesNotDependOnPlaceOrientationOrderOrScale) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = test::random_cylinder(seed, 3, {});
    const double width = min_zone_cylinder(points)->width_mm();
    const Eigen::Isometry3d place = random_place(seed, 300.0);
    Points3 moved;
    Points3 scaled;
    for (const auto& p : points) {
      moved.emplace_back(place * p);
      scaled.emplace_back(0.01 * p);
    }
    const Points3 reversed(points.rbegin(), points.rend());
    const auto found = min_zone_cylinder(moved);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->width_mm(), width, 1e-11);
    EXPECT_NEAR(std::abs(found->axis.direction.dot(place.linear() *
                                                   min_zone_cylinder(points)->axis.direction)),
                1.0, 1e-12);
    EXPECT_NEAR(min_zone_cylinder(scaled)->width_mm(), 0.01 * width, 1e-13);
    EXPECT_NEAR(min_zone_cylinder(reversed)->width_mm(), width, 1e-12);
  }
}

// Certificates section 1: on short discs the tilt is held by curvature and optima with five
// contacts are common; a method that expects six stalls up to 1.1e-3 of the zone above them.
TEST(MinZoneCylinder, ReachesOptimaWithFiveContacts) {
  int fives = 0;
  for (const double half_length : {5.0, 1.0, 0.25}) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      SCOPED_TRACE(seed);
      const Points3 points = test::random_cylinder(seed, 3, {3, 7, half_length, 0.00125});
      const auto zone = min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
      ASSERT_TRUE(zone.has_value());
      EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kLocal) << zone->certificate.reason;
      EXPECT_LE(zone->certificate.gap_mm, 1e-10 * zone->width_mm());
      if (zone->outer.size() + zone->inner.size() == 5) ++fives;
    }
  }
  EXPECT_GE(fives, 5);
}

/// Two contacts of its first minimum carry 5e-6; behind them a valley 2 um long leads to another
/// minimum, 1.2e-8 mm lower. Seed 19 of the benchmark's sets of 24 points.
const Points3& valley() {
  static const Points3 points = {
      {24.517644878, -4.616975467, 10.041672081}, {16.457705324, 19.791000887, 10.522323154},
      {1.962844038, 25.794428197, 10.561877946},  {-19.491368530, 16.366436463, 10.221759863},
      {-24.706328434, 3.714756518, 9.913564885},  {-14.075276033, -19.701029911, 9.470677152},
      {7.528947076, -23.009700852, 9.534480459},  {13.587578896, -20.194841822, 9.633846958},
      {24.920277897, -0.763435135, 40.135789166}, {13.388649595, 21.280890172, 40.543160244},
      {4.113295085, 24.859575050, 40.562747657},  {-14.210609626, 20.823250423, 40.359678605},
      {-24.709588261, 4.373631668, 39.935587042}, {-10.991288139, -22.264737695, 39.441958404},
      {2.974052584, -24.597801614, 39.478972727}, {13.190165660, -20.983566251, 39.621878974},
      {24.653103782, 1.744705898, 70.196407790},  {16.801367182, 17.829332219, 70.497181098},
      {2.440905891, 24.413816220, 70.550229604},  {-21.214855531, 13.183502674, 70.157036323},
      {-25.180182105, 1.383250426, 69.875232220}, {-13.935664374, -21.357179669, 69.450902896},
      {0.499202896, -25.420536849, 69.453203312}, {13.174212272, -21.529525188, 69.617593907},
  };
  return points;
}

TEST(MinZoneCylinder, GoesToTheBetterEndOfAValleyThatWeakContactsClose) {
  const Eigen::Vector3d near(0.0, 0.065, 0.998);
  CylinderProofOptions options;
  options.scopes = {{AxisScope::Kind::kCone, near}};
  const auto proven = min_zone_cylinder(valley(), near, options);
  ASSERT_TRUE(proven.has_value()) << proven.error().what;
  ASSERT_EQ(proven->certificate.kind, Certificate::Kind::kGlobal) << proven->certificate.reason;
  CylinderZoneFitter fitter;
  const auto zone = fitter.fit(valley(), near);
  ASSERT_TRUE(zone.has_value());
  EXPECT_EQ(zone->ending, ZoneEnding::kConverged);
  EXPECT_NEAR(zone->width_mm(), proven->width_mm(), 1e-12);
}

// A bow touched at the same angles in every section has points that differ by less than rounding.
// They held the descent 3.2e-9 mm above the zone about the axis of the inscribed cylinder.
TEST(MinZoneCylinder, LeavesASaddleThatPointsWhichTieHold) {
  std::vector<Eigen::Vector3d> points;
  const auto digits = [](double mm) { return std::round(1e7 * mm) * 1e-7; };
  for (int layer = 0; layer < 5; ++layer) {
    for (int i = 0; i < 12; ++i) {
      const double angle = 0.04443673584939426 + core::kTwoPi * i / 12.0;
      const double u = 0.5 * layer - 1.0;
      const double r = 5.0 + 2e-3 * u * u * std::cos(angle + 3.9692012099842597);
      points.emplace_back(digits(r * std::cos(angle)), digits(r * std::sin(angle)), 100.0 * u);
    }
  }
  const auto zone = min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
  const auto inscribed = max_inscribed_cylinder(points, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(zone && inscribed);
  EXPECT_LE(zone->width_mm(), inscribed->deviation_mm + 1e-12);
  EXPECT_NE(zone->certificate.kind, Certificate::Kind::kNone);
}

TEST(MinZoneCylinder, FindsThePlantedContactsOfALargeSet) {
  // All points well inside the zone but six that hold it.
  Points3 points = test::random_cylinder(9, 3, {40, 500, 35.0, 0.0});
  core::KeyedNoise noise(9, {6});
  for (auto& p : points) {
    const double r = 25.0 + 0.002 * (2.0 * noise.uniform() - 1.0);
    p.head<2>() *= r / p.head<2>().norm();
  }
  const std::vector<std::size_t> outer = {100, 5170, 10330, 15440};
  const std::vector<std::size_t> inner = {350, 19600};
  for (const std::size_t i : outer) points[i].head<2>() *= 25.004 / points[i].head<2>().norm();
  for (const std::size_t i : inner) points[i].head<2>() *= 24.996 / points[i].head<2>().norm();
  const auto zone = min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(zone.has_value());
  EXPECT_LE(zone->width_mm(), 0.008 + 1e-12);
  EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kLocal) << zone->certificate.reason;
  expect_stationary(points, *zone);
}

TEST(MinZoneCylinder, RefusesWhatHasNoAxis) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(min_zone_cylinder({}).error().code, core::Code::kNoPoints);
  EXPECT_EQ(min_zone_cylinder(Points3{z, 2 * z, 3 * z, 4 * z}).error().code,
            core::Code::kTooFewPoints);
  EXPECT_EQ(min_zone_cylinder(Points3{z, 2 * z, 3 * z, 4 * z, 5 * z, 6 * z}).error().code,
            core::Code::kCollinear);
  Points3 ring;
  for (int k = 0; k < 12; ++k)
    ring.emplace_back(25 * std::cos(0.5 * k), 25 * std::sin(0.5 * k), 10.0);
  const auto single = min_zone_cylinder(ring);
  EXPECT_EQ(single.error().code, core::Code::kRank);
  EXPECT_NE(single.error().what.find("roundness"), std::string::npos);
  Points3 infinite = test::random_cylinder(1, 3, {});
  infinite[17].y() = std::numeric_limits<double>::infinity();
  const auto bad = min_zone_cylinder(infinite);
  EXPECT_EQ(bad.error().code, core::Code::kNotFinite);
  EXPECT_NE(bad.error().what.find("point 17"), std::string::npos);
}

TEST(LsCylinder, IsExactOnPointsOfACylinder) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = test::random_cylinder(seed, 3, {3, 6, 20.0, 0.0});
    const Eigen::Isometry3d place = random_place(seed, 500.0);
    Points3 moved;
    for (const auto& p : points) moved.emplace_back(place * p);
    const auto ls = ls_cylinder(moved);
    ASSERT_TRUE(ls.has_value());
    EXPECT_NEAR(ls->radius_mm, 25.0, 1e-11);
    EXPECT_NEAR(distance_mm(ls->axis, place.translation()), 0.0, 1e-11);
    EXPECT_LT(ls->deviation_mm, 1e-11);
  }
}

TEST(MinZoneCylinder, SaysHowTheDescentEnded) {
  const Points3 few = test::random_cylinder(2, 21, {3, 3, 35.0, 0.003});
  const auto zone = min_zone_cylinder(few, Eigen::Vector3d::UnitZ());
  ASSERT_TRUE(zone.has_value());
  EXPECT_EQ(zone->ending, ZoneEnding::kConverged);
  // Also after a restart of the global search.
  int restarted = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Points3 arc = test::random_cylinder(seed, 21, {3, 8, 0.1, 0.00125});
    const auto local = min_zone_cylinder(arc, Eigen::Vector3d::UnitZ());
    const AxisScope cone{AxisScope::Kind::kCone};
    const auto global =
        min_zone_cylinder(arc, Eigen::Vector3d::UnitZ(), {.scopes = {cone}, .search = {}});
    ASSERT_TRUE(local && global);
    EXPECT_EQ(global->ending, ZoneEnding::kConverged);
    if (global->width_mm() < local->width_mm() - 1e-9) ++restarted;
  }
  EXPECT_GT(restarted, 0);
}

/// The rows of a certificate: contacts that differ by round-off, in a box that is far larger.
TEST(ZoneProgram, OfRowsThatDifferByRoundOffTakesFewPivots) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    core::KeyedNoise noise(seed, {1});
    ZoneRows<4> rows;
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector2d side(std::cos(0.25 * M_PI * k), std::sin(0.25 * M_PI * k));
      rows.push_back(1.8e-15 * std::floor(3.0 * noise.uniform()),
                     {-side.x(), -side.y(), -side.x(), -side.y()});
    }
    const auto step = solve_zone_program<4>(rows, 0.04, kMinimumCircumscribed);
    EXPECT_TRUE(step.solved);
    EXPECT_LT(step.pivots, 20);
  }
}

}  // namespace
}  // namespace rondure::fit
