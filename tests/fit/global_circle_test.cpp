// The global certificate of circles: branch and bound against the enumeration, planted rivals,
// sampling.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/geometry/internal/bisectors.h"
#include "fit/references/min_zone.h"
#include "fit/zone/global_search.h"
#include "fit/zone/internal/regions.h"

namespace rondure::fit {
namespace {

using Points2 = std::vector<Eigen::Vector2d>;

Points2 placed_circle(std::uint64_t seed, int count, double arc_deg, double noise_mm) {
  core::KeyedNoise noise(seed, {12});
  const Eigen::Vector2d center(40.0 * noise.normal(), 40.0 * noise.normal());
  Points2 points;
  for (int k = 0; k < count; ++k) {
    const double theta = arc_deg * core::kDegree * (k + 0.5 * noise.uniform()) / count;
    const double r = 25.0 + noise_mm * noise.normal();
    points.emplace_back(center + r * Eigen::Vector2d(std::cos(theta), std::sin(theta)));
  }
  return points;
}

double zone_about(const Points2& points, const Eigen::Vector2d& center) {
  double low = 1e300;
  double high = 0.0;
  for (const auto& p : points) {
    low = std::min(low, (p - center).norm());
    high = std::max(high, (p - center).norm());
  }
  return high - low;
}

/// All candidates of the enumeration lie among the bisectors of a disc; this is the narrowest.
double enumerated(const Points2& points, const Eigen::Vector2d& start) {
  const auto all = search_bisectors(points, start);
  EXPECT_TRUE(all.complete);
  return all.width_mm;
}

GlobalSearch<Eigen::Vector2d> search(const Points2& points, const MinZoneCircle& zone,
                                     double growth = 0.0) {
  return search_centers(points, zone.center_mm, {zone.width_mm(), growth, zone.outer, zone.inner});
}

TEST(GlobalCircle, IsProvenForLargeSetsOfAnyArc) {
  for (const double arc_deg : {360.0, 200.0, 60.0}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(testing::Message() << arc_deg << " deg, seed " << seed);
      const auto zone =
          min_zone_circle(placed_circle(seed, 41 + 37 * static_cast<int>(seed), arc_deg, 0.002));
      ASSERT_TRUE(zone.has_value());
      EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kGlobal) << zone->certificate.reason;
      EXPECT_EQ(zone->certificate.scope, "all centres");
      EXPECT_LE(zone->certificate.gap_mm, 1e-9);
    }
  }
}

TEST(GlobalCircle, AgreesWithTheEnumerationOnSmallSets) {
  for (const double arc_deg : {360.0, 150.0, 60.0, 30.0}) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
      SCOPED_TRACE(testing::Message() << arc_deg << " deg, seed " << seed);
      const Points2 points = placed_circle(seed, 6 + static_cast<int>(seed % 20), arc_deg, 0.003);
      const auto zone = min_zone_circle(points, {.global = false, .search = {}});
      ASSERT_TRUE(zone.has_value());
      const double least = enumerated(points, zone->center_mm);
      const auto found = search(points, *zone);
      if (found.proven) {
        EXPECT_NEAR(zone->width_mm(), least, 1.001e-9);
        EXPECT_GE(found.lower_mm, zone->width_mm() - 1.001e-9);
      } else {
        ASSERT_TRUE(found.better) << found.reason;
        EXPECT_LT(least, zone->width_mm());
        EXPECT_LT(zone_about(points, *found.better), zone->width_mm());
      }
    }
  }
}

TEST(GlobalCircle, NeverCallsAnotherCentreGlobal) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Points2 points = placed_circle(seed, 60, seed % 2 == 0 ? 360.0 : 70.0, 0.003);
    auto zone = min_zone_circle(points);
    ASSERT_TRUE(zone.has_value());
    core::KeyedNoise noise(seed, {13});
    zone->center_mm += 1e-4 * Eigen::Vector2d(noise.normal(), noise.normal());
    const double wider = zone_about(points, zone->center_mm);
    const auto found =
        search_centers(points, zone->center_mm, {wider, 0.0, zone->outer, zone->inner});
    EXPECT_FALSE(found.proven);
    ASSERT_TRUE(found.better);
    EXPECT_LT(zone_about(points, *found.better), wider);
  }
}

// Every centre of a square that is called excluded must have a wider zone, and none lies outside
// the region that can hold a narrow one.
TEST(GlobalCircle, BoundsHoldForRandomCentres) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Points2 points = placed_circle(seed, 30, 40.0 + 8.0 * static_cast<double>(seed), 0.01);
    std::vector<Eigen::Vector3d> flat;
    for (const auto& p : points) flat.emplace_back(p.x(), p.y(), 0.0);
    const auto zone = min_zone_circle(points);
    ASSERT_TRUE(zone.has_value());
    core::KeyedNoise noise(seed, {14});
    for (int k = 0; k < 200; ++k) {
      const double width = zone->width_mm() * (1.0 + 3.0 * noise.uniform());
      const auto region = center_region(points, width);
      ASSERT_EQ(region.kind, CenterRegion::Kind::kSquare);
      const double h = 10.0 * std::pow(10.0, -5.0 * noise.uniform());
      const Eigen::Vector2d middle =
          zone->center_mm + 2.0 * h * Eigen::Vector2d(noise.normal(), noise.normal());
      const auto bound = bound_zone_box<2>(flat, {middle, h, 0.0}, width, 1e-9, 1e-12);
      for (int i = 0; i < 50; ++i) {
        const Eigen::Vector2d c =
            middle + h * Eigen::Vector2d(2.0 * noise.uniform() - 1.0, 2.0 * noise.uniform() - 1.0);
        const double w = zone_about(points, c);
        ASSERT_GE(w, bound.lower_mm);
        const double apart = (c - region.center_mm).cwiseAbs().maxCoeff();
        ASSERT_TRUE(w > width || apart <= region.half_side_mm);
      }
    }
  }
}

TEST(GlobalCircle, DoesNotDependOnLuckAtTheLimit) {
  const Points2 points = placed_circle(5, 300, 50.0, 0.01);
  const CenterProofOptions few{.global = true, .search = {.max_boxes = 1}};
  const auto a = min_zone_circle(points, few);
  const auto b = min_zone_circle(points, few);
  ASSERT_TRUE(a.has_value() && b.has_value());
  EXPECT_EQ(a->certificate.reason, b->certificate.reason);
  EXPECT_EQ(a->center_mm, b->center_mm);
}

}  // namespace
}  // namespace rondure::fit
