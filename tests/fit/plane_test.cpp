#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/plane.h"
#include "fit/profiles/form_parameters.h"
#include "fit/references/min_zone.h"
#include "tests/fit/drawing_cases.h"

// Expected numbers: methods, drawing section 12.

namespace rondure::fit {
namespace {

using test::all_of;
using Space = std::vector<Eigen::Vector3d>;
constexpr double kDigits = 1e-10;
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

std::vector<std::size_t> rows(const std::vector<Contact>& contacts) {
  std::vector<std::size_t> out;
  for (const Contact& c : contacts) out.push_back(c.index);
  std::ranges::sort(out);
  return out;
}

TEST(LsPlane, GivesTheFlatnessOfTheFaceWithASaucer) {
  const Space points = all_of(test::w4_face());
  const auto plane = ls_plane(points, kUp);
  ASSERT_TRUE(plane.has_value());
  EXPECT_NEAR(plane->deviation_mm, 0.005428189038, kDigits);
  const auto form = flatness_parameters(points, plane->plane);
  ASSERT_TRUE(form.has_value());
  EXPECT_NEAR(form->total_mm, 0.005428189038, kDigits);
  EXPECT_NEAR(form->peak_mm, 0.002344499915, kDigits);
  EXPECT_NEAR(form->valley_mm, 0.003083689123, kDigits);
  EXPECT_NEAR(form->rms_mm, 0.001829028978, kDigits);
  const auto other_side = ls_plane(points, Eigen::Vector3d(-kUp));
  EXPECT_NEAR(flatness_parameters(points, other_side->plane)->peak_mm, form->valley_mm, 1e-15);
}

TEST(LsPlane, GivesTheFlatnessOfTheCrownedPlane) {
  EXPECT_NEAR(ls_plane(test::w5_plane(), kUp)->deviation_mm, 0.00642, kDigits);
}

TEST(LsPlane, RefusesPointsWithoutAPlane) {
  EXPECT_EQ(ls_plane(Space{}).error().code, core::Code::kNoPoints);
  EXPECT_EQ(ls_plane(Space{{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}).error().code,
            core::Code::kTooFewPoints);
  EXPECT_EQ(ls_plane(Space{{0, 0, 0}, {1, 1, 0}, {3, 3, 0}}).error().code, core::Code::kCollinear);
  const Space cube = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                      {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  EXPECT_EQ(ls_plane(cube).error().code, core::Code::kRank);
}

// Four corners: their standard deviations are half of the sides.
TEST(LsPlane, NeedsPointsThatSpreadAcrossTheirLength) {
  for (const double width : {0.9, 1.1}) {
    const Space strip = {{0, 0, 0}, {100, 0, 0}, {0, width, 0}, {100, width, 0.001}};
    const auto plane = ls_plane(strip, kUp);
    EXPECT_EQ(plane.has_value(), width > 1.0);
    EXPECT_EQ(min_zone_plane(strip, kUp).has_value(), width > 1.0);
    if (width < 1.0) {
      EXPECT_EQ(plane.error().code, core::Code::kCollinear);
    }
  }
}

TEST(MinZonePlane, IsThatOfTheFaceWithASaucer) {
  const auto zone = min_zone_plane(all_of(test::w4_face()), kUp);
  ASSERT_TRUE(zone.has_value());
  EXPECT_EQ(zone->ending, ZoneEnding::kConverged);
  EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kGlobal);
  EXPECT_NEAR(zone->width_mm, 0.005350052640, kDigits);
  EXPECT_EQ(rows(zone->top), (std::vector<std::size_t>{1, 7}));
  EXPECT_EQ(rows(zone->bottom), (std::vector<std::size_t>{15, 21}));
}

TEST(MinZonePlane, IsThatOfTheCrownedPlane) {
  const auto zone = min_zone_plane(test::w5_plane(), kUp);
  ASSERT_TRUE(zone.has_value());
  EXPECT_NEAR(zone->width_mm, 0.00635, kDigits);
  EXPECT_EQ(rows(zone->top), (std::vector<std::size_t>{6, 7}));
  EXPECT_EQ(rows(zone->bottom), (std::vector<std::size_t>{0, 14}));
  EXPECT_NEAR(zone->outer.normal.x() / zone->outer.normal.z(), 3.75e-6, 1e-12);
  EXPECT_NEAR(zone->outer.normal.y() / zone->outer.normal.z(), -8e-6, 1e-12);
  EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kGlobal);
}

/// Points of a plane of about `size` mm with the form `form`, in any place.
Space drawn(std::uint64_t seed, int count, double form) {
  core::KeyedNoise noise(seed, {71});
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(
      noise.normal(), Eigen::Vector3d(noise.normal(), 1.0, noise.normal()).normalized()));
  Space out;
  for (int i = 0; i < count; ++i) {
    const double x = 40.0 * (noise.uniform() - 0.5);
    const double y = 25.0 * (noise.uniform() - 0.5);
    out.push_back(turn * Eigen::Vector3d(x, y, form * noise.normal()) +
                  Eigen::Vector3d(200.0, -30.0, 7.0));
  }
  return out;
}

/// The least width along all normals of a face or of two edges, one of which is the optimum.
double least_of_all(const Space& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      for (std::size_t k = i; k < points.size(); ++k) {
        for (std::size_t l = k + 1; l < points.size(); ++l) {
          const Eigen::Vector3d normal = (points[j] - points[i]).cross(points[l] - points[k]);
          if (normal.norm() < 1e-9) continue;
          const Eigen::Vector3d n = normal.normalized();
          const auto height = [&](const auto& p) { return n.dot(p - points[0]); };
          least = std::min(least, extremes_of(points, height).width());
        }
      }
    }
  }
  return least;
}

TEST(MinZonePlane, IsTheLeastOfAllFacesAndPairsOfEdges) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    // From a lapped face to a rough one as thick as a tenth of its width.
    const double form = std::pow(10.0, -static_cast<double>(seed % 5));
    const Space points = drawn(seed, 5 + static_cast<int>(seed % 8), form);
    const auto zone = min_zone_plane(points);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    EXPECT_EQ(zone->ending, ZoneEnding::kConverged);
    if (zone->certificate.kind == Certificate::Kind::kGlobal) {
      EXPECT_NEAR(zone->width_mm, least_of_all(points), 1e-11);
    } else {
      EXPECT_GE(form, 0.1);
    }
    EXPECT_LE(zone->width_mm, ls_plane(points)->deviation_mm);
  }
}

TEST(MinZonePlane, MultipliersJoinTheHullsOfTheContactsAlongTheNormal) {
  const Space points = drawn(3, 40, 0.01);
  const auto zone = min_zone_plane(points);
  ASSERT_TRUE(zone.has_value());
  Eigen::Vector3d difference = -zone->width_mm * zone->outer.normal;
  for (const Contact& c : zone->top) {
    difference += c.multiplier * points[c.index];
    EXPECT_NEAR(height_mm(zone->outer, points[c.index]), 0.0, 1e-12);
  }
  for (const Contact& c : zone->bottom) {
    difference -= c.multiplier * points[c.index];
    EXPECT_NEAR(height_mm(zone->outer, points[c.index]), -zone->width_mm, 1e-12);
  }
  EXPECT_LT(difference.norm(), 1e-12);
  EXPECT_EQ(zone->top.size() + zone->bottom.size(), 4U);
}

TEST(MinZonePlane, DoesNotDependOnOrderPlaceOrRepeatedPoints) {
  Space points = drawn(9, 30, 0.004);
  const double width = min_zone_plane(points)->width_mm;
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 3).normalized()));
  std::ranges::reverse(points);
  points.insert(points.end(), points.begin(), points.begin() + 10);
  for (auto& p : points) p = turn * p + Eigen::Vector3d(1e3, 1e3, -1e3);
  EXPECT_NEAR(min_zone_plane(points)->width_mm, width, 1e-9);
}

TEST(MinZonePlane, OfThreePointsIsFlat) {
  const auto zone = min_zone_plane(Space{{0, 0, 1}, {5, 0, 1}, {0, 7, 2}});
  ASSERT_TRUE(zone.has_value());
  EXPECT_NEAR(zone->width_mm, 0.0, 1e-15);
}

TEST(MinZonePlane, OfPointsAsThickAsWideIsNotSaidToBeTheLeastUnlessItIs) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Space points = drawn(seed, 7, 9.0);
    const auto zone = min_zone_plane(points);
    if (!zone) {
      EXPECT_EQ(zone.error().code, core::Code::kRank);
    } else if (zone->certificate.kind == Certificate::Kind::kGlobal) {
      EXPECT_NEAR(zone->width_mm, least_of_all(points), 1e-9);
    }
  }
}

// Points on a side of a turned grid are on one line but for rounding: "the points extend 0 mm".
TEST(MinZonePlane, OfAGridDoesNotDependOnHowItIsTurned) {
  for (int k = 0; k < 200; ++k) {
    const Eigen::AngleAxisd turn(0.03 * k, kUp);
    Space points;
    for (int i = 0; i < 100; ++i) {
      const double u = i / 10 - 4.5;
      points.push_back(turn * Eigen::Vector3d(4.0 * u, 4.0 * (i % 10) - 18.0, 1e-4 * u * u));
    }
    const auto zone = min_zone_plane(points, kUp);
    ASSERT_TRUE(zone) << k << ": " << zone.error().what;
    EXPECT_NEAR(zone->width_mm, 1e-4 * (4.5 * 4.5 - 0.5 * 0.5), kDigits) << k;
  }
}

}  // namespace
}  // namespace rondure::fit
