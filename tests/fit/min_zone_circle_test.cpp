#include "fit/references/min_zone.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/geometry/internal/bisectors.h"
#include "fit/least_squares/circle.h"

namespace rondure::fit {
namespace {

using Points2 = std::vector<Eigen::Vector2d>;

Points2 noisy_circle(std::uint64_t seed, int count, double arc_deg, double noise_mm) {
  core::KeyedNoise noise(seed, {2});
  Points2 points;
  for (int k = 0; k < count; ++k) {
    const double theta = arc_deg * core::kDegree * (k + 0.5 * noise.uniform()) / count;
    const double r = 25.0 + noise_mm * noise.normal();
    points.emplace_back(r * std::cos(theta), r * std::sin(theta));
  }
  return points;
}

/// All candidates there are: every crossing of two bisectors, anywhere in the plane.
double brute_force(const Points2& points) {
  struct Line {
    Eigen::Vector2d n;
    double c;
  };
  std::vector<Line> lines;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      lines.push_back(
          {points[j] - points[i], 0.5 * (points[j].squaredNorm() - points[i].squaredNorm())});
    }
  }
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (std::size_t j = i + 1; j < lines.size(); ++j) {
      const double det = lines[i].n.x() * lines[j].n.y() - lines[i].n.y() * lines[j].n.x();
      if (std::abs(det) < 1e-9) continue;
      const Eigen::Vector2d c((lines[i].c * lines[j].n.y() - lines[j].c * lines[i].n.y()) / det,
                              (lines[i].n.x() * lines[j].c - lines[j].n.x() * lines[i].c) / det);
      double low = 1e300;
      double high = 0.0;
      for (const auto& p : points) {
        low = std::min(low, (p - c).norm());
        high = std::max(high, (p - c).norm());
      }
      best = std::min(best, high - low);
    }
  }
  return best;
}

TEST(MinZoneCircle, AgreesWithAllBisectorCrossings) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const Points2 points = noisy_circle(seed, 6 + static_cast<int>(seed % 9), 360.0, 0.003);
    const auto zone = min_zone_circle(points);
    ASSERT_TRUE(zone.has_value());
    EXPECT_NEAR(zone->width_mm(), brute_force(points), 1e-11);
    EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kGlobal);
    EXPECT_LE(zone->width_mm(), ls_circle(points)->deviation_mm + 1e-13);
  }
}

TEST(MinZoneCircle, HoldsTiesDuplicatesAndSpokes) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    Points2 points = noisy_circle(seed, 9, 360.0, 0.004);
    // Rounded to 1 um, every point twice, and a second point on the ray of the first.
    for (auto& p : points) p = (p * 1e3).array().round().matrix() / 1e3;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) points.push_back(points[i]);
    points.push_back(points.front() * (1.0 + 1e-4));
    const auto zone = min_zone_circle(points);
    ASSERT_TRUE(zone.has_value());
    EXPECT_NEAR(zone->width_mm(), brute_force(points), 1e-10);
  }
}

TEST(MinZoneCircle, CertifiesLocallyWhenAskedForNoMore) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto zone =
        min_zone_circle(noisy_circle(seed, 500, 360.0, 0.002), {.global = false, .search = {}});
    ASSERT_TRUE(zone.has_value());
    EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kLocal) << zone->certificate.reason;
    EXPECT_LE(zone->certificate.gap_mm, 1e-10 * zone->width_mm());
    EXPECT_GE(zone->outer.size(), 2U);
    EXPECT_GE(zone->inner.size(), 2U);
  }
}

TEST(MinZoneCircle, FitsThreePointsExactly) {
  const auto zone = min_zone_circle(Points2{{25, 0}, {0, 25}, {-25, 0}});
  ASSERT_TRUE(zone.has_value());
  EXPECT_TRUE(zone->exact_fit);
  EXPECT_EQ(zone->width_mm(), 0.0);
}

TEST(MinZoneCircle, FindsTheGlobalMinimumOfNarrowArcsToo) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    const Points2 points = noisy_circle(seed, 9 + static_cast<int>(seed % 4), 60.0, 0.002);
    const auto zone = min_zone_circle(points);
    ASSERT_TRUE(zone.has_value());
    EXPECT_NEAR(zone->width_mm(), brute_force(points), 1e-9);
    EXPECT_EQ(zone->certificate.kind, Certificate::Kind::kGlobal);
  }
}

TEST(MinZoneCircle, ClaimsNothingGlobalWhereTheZoneMayBeAStrip) {
  // Two parallel rows: whichever way a circle bends, it is wider than the strip between them.
  Points2 points;
  for (int k = 0; k < 20; ++k) points.emplace_back(k, k % 2 == 0 ? 0.01 : -0.01);
  const auto zone = min_zone_circle(points);
  ASSERT_TRUE(zone.has_value());
  EXPECT_NE(zone->certificate.kind, Certificate::Kind::kGlobal);
}

}  // namespace
}  // namespace rondure::fit
