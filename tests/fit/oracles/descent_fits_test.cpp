// The cylinder fits against the independent descent from several starts, on measured-like sets:
// 100 of each kind with RONDURE_FULL=1 (dial.h): shafts, rings and arcs.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "core/units.h"
#include "cylinder_sets.h"
#include "descent.h"
#include "dial.h"
#include "fit/references/min_zone.h"

namespace rondure::test {
namespace {

constexpr int kDescents = 100;
constexpr int kStarts = 6;

/// The best of several descents: from the nominal axis and from random ones around it.
Real best_near_nominal(const Points3& points, Reference reference, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {102});
  const auto spread = [&](double size) {
    return Vector3r(size * noise.normal(), size * noise.normal(), 0.0L);
  };
  Real best = 1e300L;
  for (int k = 0; k < kStarts; ++k) {
    const double size = k == 0 ? 0.0 : 0.05;
    const Vector3r point = spread(size);
    const Vector3r direction = Vector3r::UnitZ() + spread(0.05 * size);
    const AxisOptimum found = descend(points, point, direction, reference, 0.05L);
    if (found.direction.z() > 0.99L) best = std::min(best, found.at.value_mm(reference));
  }
  return best;
}

/// The stated radii are the distances of the points, in long double.
void expect_radii(const Points3& points, const fit::MinZoneCylinder& zone) {
  const Extremes at =
      extremes(points, zone.axis.point_mm.cast<Real>(), zone.axis.direction.cast<Real>());
  EXPECT_NEAR(zone.inner_radius_mm, static_cast<double>(at.low_mm), 1e-12);
  EXPECT_NEAR(zone.outer_radius_mm, static_cast<double>(at.high_mm), 1e-12);
}

/// And no descent from there finds a narrower zone.
void expect_local(const Points3& points, const fit::MinZoneCylinder& zone) {
  expect_radii(points, zone);
  const AxisOptimum below = descend(points, zone.axis.point_mm.cast<Real>(),
                                    zone.axis.direction.cast<Real>(), Reference::kMinZone, 1e-4L);
  EXPECT_NEAR(zone.width_mm(), static_cast<double>(below.at.value_mm(Reference::kMinZone)), 1e-12);
}

TEST(DescentFits, ProvenMinZoneCylinderIsTheDescentsBest) {
  fit::CylinderProofOptions options;
  options.scopes = {{fit::AxisScope::Kind::kCone}};
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kDescents)); ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = part(seed, core::kTwoPi).points;
    const auto zone = fit::min_zone_cylinder(points, Eigen::Vector3d::UnitZ(), options);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    EXPECT_EQ(zone->certificate.kind, fit::Certificate::Kind::kGlobal) << zone->certificate.reason;
    EXPECT_NEAR(zone->width_mm(),
                static_cast<double>(best_near_nominal(points, Reference::kMinZone, seed)), 1e-9);
    expect_radii(points, *zone);
  }
}

TEST(DescentFits, MinZoneCylinderOfAnArcIsALocalMinimumOfTheDescent) {
  const int sets = count(kDescents);
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(sets); ++seed) {
    SCOPED_TRACE(seed);
    const double arc_deg = 70.0 + 100.0 * static_cast<double>(seed) / sets;
    const Points3 points = part(seed, arc_deg * core::kDegree).points;
    const auto zone = fit::min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    expect_local(points, *zone);
  }
}

TEST(DescentFits, LocalMinZoneCylinderIsALocalMinimumOfTheDescent) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(10 * kDescents)); ++seed) {
    SCOPED_TRACE(seed);
    const Points3 points = part(seed, core::kTwoPi).points;
    const auto zone = fit::min_zone_cylinder(points, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    expect_local(points, *zone);
  }
}

}  // namespace
}  // namespace rondure::test
