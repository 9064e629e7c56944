// The fits against planted sets: 1 000 of each kind with RONDURE_FULL=1 (dial.h). Zone and place to
// 1e-9 mm, direction to 1e-8 rad.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "core/noise.h"
#include "dial.h"
#include "fit/references/min_zone.h"
#include "planted.h"

namespace rondure::test {
namespace {

/// The rows of contacts, those of two sides together.
std::vector<std::size_t> rows(const std::vector<fit::Contact>& a,
                              const std::vector<fit::Contact>& b = {}) {
  std::vector<std::size_t> out;
  for (const auto& c : a) out.push_back(c.index);
  for (const auto& c : b) out.push_back(c.index);
  return sorted(out);
}

/// A start direction as a plan has it: some degrees off.
Eigen::Vector3d nominal(const PlantedCylinder& set, std::uint64_t seed) {
  core::KeyedNoise noise(seed, {95});
  const Eigen::Vector3d u = set.direction.unitOrthogonal();
  const double tilt = 0.03 * noise.uniform();
  const Eigen::Vector3d start = set.direction + tilt * u;
  return noise.uniform() < 0.5 ? start : -start;
}

void expect_axis(const PlantedCylinder& set, const fit::Axis& axis) {
  EXPECT_LT(fit::distance_mm({set.center_mm, set.direction}, axis.point_mm), kPlace);
  EXPECT_LT(axis.direction.cross(set.direction).norm(), kDirection);
}

TEST(PlantedFits, MinZoneCircle) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kPlanted)); ++seed) {
    SCOPED_TRACE(seed);
    const PlantedCircle set = plant_circle(draw_plot(Reference::kMinZone, seed), seed);
    const auto zone = fit::min_zone_circle(set.points);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    EXPECT_NEAR(zone->width_mm(), set.optimum.outer_mm - set.optimum.inner_mm, kPlace);
    EXPECT_NEAR(zone->outer_radius_mm, set.optimum.outer_mm, kPlace);
    EXPECT_LT((zone->center_mm - set.center_mm).norm(), kPlace);
    EXPECT_EQ(rows(zone->outer, zone->inner), sorted(set.optimum.contacts));
    EXPECT_EQ(zone->certificate.kind, fit::Certificate::Kind::kGlobal) << zone->certificate.reason;
  }
}

void expect_min_zone_cylinders(bool curved) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(kPlanted)); ++seed) {
    SCOPED_TRACE(seed);
    Plot plot = draw_plot(Reference::kMinZone, seed);
    plot.curved = curved;
    const PlantedCylinder set = plant_cylinder(plot, seed);
    const auto zone = fit::min_zone_cylinder(set.points, nominal(set, seed));
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    EXPECT_NEAR(zone->width_mm(), set.optimum.outer_mm - set.optimum.inner_mm, kPlace);
    EXPECT_NEAR(zone->outer_radius_mm, set.optimum.outer_mm, kPlace);
    expect_axis(set, zone->axis);
    EXPECT_EQ(rows(zone->outer, zone->inner), sorted(set.optimum.contacts));
    EXPECT_EQ(zone->certificate.kind, fit::Certificate::Kind::kLocal) << zone->certificate.reason;
  }
}

TEST(PlantedFits, MinZoneCylinderWithSixContacts) { expect_min_zone_cylinders(false); }

TEST(PlantedFits, MinZoneCylinderWithFiveContacts) { expect_min_zone_cylinders(true); }

TEST(PlantedFits, MinZoneCylinderFoundWithoutAStartDirection) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(count(200)); ++seed) {
    SCOPED_TRACE(seed);
    Plot plot = draw_plot(Reference::kMinZone, seed);
    plot.half_length_mm = std::max(plot.half_length_mm, 1.2 * plot.radius_mm);
    const PlantedCylinder set = plant_cylinder(plot, seed);
    const auto zone = fit::min_zone_cylinder(set.points);
    ASSERT_TRUE(zone.has_value()) << zone.error().what;
    EXPECT_NEAR(zone->width_mm(), set.optimum.outer_mm - set.optimum.inner_mm, kPlace);
    expect_axis(set, zone->axis);
  }
}

}  // namespace
}  // namespace rondure::test
