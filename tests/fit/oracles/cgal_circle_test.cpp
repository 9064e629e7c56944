// The circle fits against exact diagrams of CGAL, up to 200 points; and CGAL against the
// enumeration, so that both oracles are tested.
#include "cgal_circle.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "circle_sets.h"
#include "dial.h"
#include "fit/references/min_zone.h"

namespace rondure::test {
namespace {

TEST(CgalCircle, EqualsTheEnumeration) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(160)); ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    const Points2 points = hard_set(seed, 4, 12);
    EXPECT_NEAR(
        static_cast<double>(cgal_min_zone(points).value_mm - brute_min_zone(points).value_mm), 0.0,
        1e-14);
    EXPECT_NEAR(static_cast<double>(cgal_circumscribed(points).value_mm -
                                    brute_circumscribed(points).value_mm),
                0.0, 1e-14);
    const auto maxima = brute_inscribed(points);
    for (const CirclePlace& m : cgal_inscribed(points)) {
      EXPECT_TRUE(std::any_of(maxima.begin(), maxima.end(), [&](const CirclePlace& known) {
        return (known.center_mm - m.center_mm).norm() < 1e-11L;
      })) << m.center_mm.cast<double>().transpose();
    }
  }
}

TEST(CgalCircle, MinZoneCircleEqualsTheOverlay) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(cases(24, 500)); ++seed) {
    SCOPED_TRACE(name_of(kind_of(seed)) + " " + std::to_string(seed));
    // All edges of a regular polygon meet in one place: slow in exact arithmetic.
    const int most = kind_of(seed) == Hard::kSymmetric ? 40 : 200;
    const int n = 13 + static_cast<int>(seed * 37 % 188);
    const Points2 points = hard_set(kind_of(seed), std::min(n, most), seed);
    const auto zone = fit::min_zone_circle(points);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    const Real best = cgal_min_zone(points).value_mm;
    EXPECT_GE(zone->width_mm(), static_cast<double>(best) - 1e-12);
    if (brute_strip(points) <= zone->width_mm()) continue;
    // A cloud is no circle: its zone is as wide as its radius, and the search may give up, if it
    // says so.
    if (kind_of(seed) == Hard::kCloud && !zone->certificate.reason.empty()) continue;
    EXPECT_EQ(zone->certificate.kind, fit::Certificate::Kind::kGlobal) << zone->certificate.reason;
    EXPECT_NEAR(zone->width_mm(), static_cast<double>(best), 1e-10);
  }
}

}  // namespace
}  // namespace rondure::test
