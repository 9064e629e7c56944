#include "fit/datums/datum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/plane.h"
#include "fit/least_squares/sections.h"
#include "fit/references/min_zone.h"
#include "tests/fit/drawing_cases.h"

// Expected numbers: methods, drawing sections 10 and 12.

namespace rondure::fit {
namespace {

using test::all_of;
using Space = std::vector<Eigen::Vector3d>;
const Eigen::Vector3d kOutward = Eigen::Vector3d::UnitZ();

Space own_median_line(const test::Layers& layers) {
  const auto cylinder = ls_cylinder(all_of(layers));
  EXPECT_TRUE(cylinder.has_value());
  return median_line(*sections_across(layers, cylinder->axis));
}

TEST(Orientation, OfABoreToACrownedPlaneDependsOnTheCandidatePlane) {
  const Space plane = test::w5_plane();
  const Space median = own_median_line(test::w5_bore());
  const auto value = [&](const Eigen::Vector3d& normal) {
    return *orientation_of_axis_mm(median, normal.normalized());
  };
  EXPECT_NEAR(value(min_zone_plane(plane, kOutward)->outer.normal), 0.003710729147, 1e-10);
  EXPECT_NEAR(value(ls_plane(plane, kOutward)->plane.normal), 0.003748467537, 1e-10);
  struct Candidate {
    std::size_t a, b, c;
    double expected;
  };
  for (const auto& [a, b, c, expected] : {Candidate{6, 7, 10, 0.002242204163},
                                          {7, 8, 10, 0.002089391254},
                                          {4, 6, 7, 0.005737736993},
                                          {4, 7, 8, 0.005679762505}}) {
    EXPECT_NEAR(value((plane[b] - plane[a]).cross(plane[c] - plane[a])), expected, 1e-10);
  }
}

TEST(Orientation, IsFreeOfThePlaceAndNeverAboveTheCoaxiality) {
  Space median = own_median_line(test::w3_c());
  const Axis datum;
  const double before = *orientation_of_axis_mm(median, datum.direction);
  EXPECT_LE(before, *coaxiality_mm(median, datum));
  for (auto& p : median) p += Eigen::Vector3d(3.0, -5.0, 100.0);
  EXPECT_NEAR(*orientation_of_axis_mm(median, datum.direction), before, 1e-12);
  EXPECT_NEAR(*orientation_of_axis_mm(median, -datum.direction), before, 1e-12);
  median.resize(1);
  EXPECT_EQ(orientation_of_axis_mm(median, datum.direction).error().code, core::Code::kRank);
}

/// Points of a plane with form, whose normal makes the angle with z, turned by `azimuth` about it.
Space inclined_plane(double angle, double azimuth, double form, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {91});
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY());
  Space out;
  for (int i = 0; i < 25; ++i) {
    out.push_back(turn * Eigen::Vector3d(10.0 * (i % 5), 6.0 * static_cast<double>(i / 5),
                                         form * noise.normal()) +
                  Eigen::Vector3d(200.0, -50.0, 30.0));
  }
  return out;
}

Eigen::Vector3d inclined_direction(double angle, double azimuth) {
  return {std::sin(angle) * std::cos(azimuth), std::sin(angle) * std::sin(azimuth),
          std::cos(angle)};
}

TEST(InclinedZone, IsTheLeastOfAllTurnsAboutTheDatum) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    // The measured plane is some 0.02 deg off the nominal angle; 1 to 90 deg.
    const double nominal =
        (seed == 12 ? 90.0 : 1.0 + 8.0 * static_cast<double>(seed - 1)) * core::kDegree;
    const Space points = inclined_plane(nominal + 3e-4, 0.7, 0.004, seed);
    const auto zone = inclined_zone(points, kOutward, nominal);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    const Eigen::Vector3d& normal = zone->outer.normal;
    EXPECT_NEAR(std::abs(normal.z()), std::cos(nominal), 1e-12);
    EXPECT_NEAR(*orientation_of_plane_mm(points, normal), zone->width_mm, 1e-11);
    // The zone has no side: its normal is that on the side of the datum.
    const Eigen::Vector3d up = normal.z() < 0.0 ? Eigen::Vector3d(-normal) : normal;
    const double azimuth = std::atan2(up.y(), up.x());
    for (int i = -3000; i <= 3000; ++i) {
      const double off = 0.1 * std::pow(i / 3000.0, 3);  // finer near the result
      EXPECT_GE(*orientation_of_plane_mm(points, inclined_direction(nominal, azimuth + off)),
                zone->width_mm - 1e-12);
    }
  }
}

TEST(InclinedZone, OfAnExactPlaneIsAsWideAsItsErrorOfAngle) {
  for (const double error : {0.0, 1e-4}) {
    const double nominal = 35.0 * core::kDegree;
    const auto zone =
        inclined_zone(inclined_plane(nominal + error, 2.0, 0.0, 1), kOutward, nominal);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    // The plane falls over 40 mm in the direction of its slope.
    EXPECT_NEAR(zone->width_mm, 40.0 * std::sin(error), 1e-8 * 40.0);
  }
}

TEST(InclinedZone, LiesOutsideTheMaterial) {
  const double nominal = 60.0 * core::kDegree;
  const Space points = inclined_plane(nominal, -1.0, 0.01, 5);
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d outward = side * inclined_direction(nominal, -1.0);
    const auto zone = inclined_zone(points, kOutward, nominal, outward);
    ASSERT_TRUE(zone.has_value());
    EXPECT_GT(zone->outer.normal.dot(outward), 0.9);
    double highest = -1e9;
    for (const auto& p : points) highest = std::max(highest, height_mm(zone->outer, p));
    EXPECT_NEAR(highest, 0.0, 1e-11);
  }
}

TEST(Angularity, OfAnAxisIsItsErrorOfAngleOverItsLength) {
  const double nominal = 30.0 * core::kDegree;
  for (const double error : {0.0, 2e-4}) {
    const Eigen::Vector3d along = inclined_direction(nominal + error, 2.5);
    const Space median = {Eigen::Vector3d(10.0, 20.0, 5.0),
                          Eigen::Vector3d(10.0, 20.0, 5.0) + 50.0 * along};
    const auto value = angularity_of_axis_mm(median, kOutward, nominal);
    ASSERT_TRUE(value.has_value()) << value.error().what;
    EXPECT_NEAR(*value, 50.0 * std::sin(error), 1e-9);
  }
}

TEST(Angularity, OfAnAxisIsTheLeastOfAllTurnsAboutTheDatum) {
  core::KeyedNoise noise(4, {92});
  const double nominal = 70.0 * core::kDegree;
  Space median;
  for (int i = 0; i < 6; ++i) {
    median.push_back(-8.0 * i * inclined_direction(nominal + 1e-4, 1.2) +
                     0.003 * Eigen::Vector3d(noise.normal(), noise.normal(), noise.normal()));
  }
  const auto value = angularity_of_axis_mm(median, kOutward, nominal);
  ASSERT_TRUE(value.has_value()) << value.error().what;
  double least = 1e9;
  for (int i = -20000; i <= 20000; ++i) {
    const Eigen::Vector3d along = inclined_direction(nominal, 1.2 + 1e-7 * i);
    least = std::min(least, *orientation_of_axis_mm(median, along));
  }
  EXPECT_NEAR(*value, least, 1e-8);
  EXPECT_LE(*value, least + 1e-12);
}

TEST(Angularity, RefusesAnglesOfParallelismAndOneSection) {
  const Space points = inclined_plane(0.5, 0.0, 0.001, 1);
  EXPECT_EQ(inclined_zone(points, kOutward, 0.0).error().code, core::Code::kBadOption);
  EXPECT_EQ(inclined_zone(points, kOutward, 2.0).error().code, core::Code::kBadOption);
  EXPECT_EQ(angularity_of_axis_mm(points, kOutward, -1.0).error().code, core::Code::kBadOption);
  EXPECT_EQ(angularity_of_axis_mm(Space{{0, 0, 1}}, kOutward, 0.5).error().code, core::Code::kRank);
}

}  // namespace
}  // namespace rondure::fit
