// The circle fits against the enumeration of all contact sets: 500 small and hard sets
// with RONDURE_FULL=1 (dial.h).
#include "brute_circle.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "circle_sets.h"
#include "dial.h"
#include "fit/least_squares/circle.h"
#include "fit/references/min_zone.h"

namespace rondure::test {
namespace {

constexpr int kEnumeratedSets = 500;

Real width(const Points2& points, const Eigen::Vector2d& center) {
  const Reach at = reach_from(points, center.cast<Real>());
  return at.high_mm - at.low_mm;
}

TEST(BruteCircle, EnumerationFindsKnownOptima) {
  // A square with the centre of its circle, moved apart: everything is known by hand.
  const Points2 points = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {0.5, 0.5}};
  EXPECT_NEAR(static_cast<double>(brute_circumscribed(points).value_mm), 1.0, 1e-15);
  EXPECT_NEAR(static_cast<double>(brute_strip(points)), std::sqrt(2.0), 1e-15);
  // Two triangles hold an empty circle: (0.5,0.5) with the two far corners.
  for (const CirclePlace& m : brute_inscribed(points)) {
    EXPECT_NEAR(static_cast<double>(m.center_mm.x() - m.center_mm.y()), 0.0, 1e-15);
    EXPECT_NEAR(static_cast<double>(m.value_mm),
                static_cast<double>(reach_from(points, m.center_mm).low_mm), 1e-15);
  }
  EXPECT_EQ(brute_inscribed(points).size(), 1U);
}

TEST(BruteCircle, EnumeratedOptimaAreNotBeatenOnAGrid) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(seed, 4, 12);
    const Real zone = std::min(brute_min_zone(points).value_mm, brute_strip(points));
    const Real around = brute_circumscribed(points).value_mm;
    for (int k = 0; k < 2500; ++k) {
      const Vector2r center(k % 50 - 25.0L, k / 50 - 25.0L);
      const Reach at = reach_from(points, center);
      EXPECT_GE(at.high_mm - at.low_mm, zone - 1e-15L);
      EXPECT_GE(at.high_mm, around - 1e-15L);
    }
  }
}

TEST(BruteCircle, MinZoneCircleEqualsTheEnumeration) {
  int strips = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kEnumeratedSets)); ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(seed, 4, 12);
    const auto zone = fit::min_zone_circle(points);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    const Real best = brute_min_zone(points).value_mm;
    const Real strip = brute_strip(points);
    EXPECT_NEAR(zone->width_mm(), static_cast<double>(width(points, zone->center_mm)), 1e-12);
    if (strip <= zone->width_mm()) {  // a centre at infinity is better: nothing can be proven
      ++strips;
      EXPECT_NE(zone->certificate.kind, fit::Certificate::Kind::kGlobal);
      EXPECT_GE(zone->width_mm(), static_cast<double>(std::min(best, strip)) - 1e-12);
      continue;
    }
    EXPECT_EQ(zone->certificate.kind, fit::Certificate::Kind::kGlobal);
    EXPECT_NEAR(zone->width_mm(), static_cast<double>(best), 1e-12);
  }
  EXPECT_LT(strips, kEnumeratedSets / 20);
}

}  // namespace
}  // namespace rondure::test
