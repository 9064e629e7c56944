#include "fit/proof/certificate.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/noise.h"
#include "core/units.h"
#include "fit/references/min_zone.h"
#include "fit/references/one_sided.h"

namespace rondure::fit {
namespace {

/// A rough section of radius 25 mm, form some 10 um.
std::vector<Eigen::Vector2d> section(std::uint64_t seed) {
  core::KeyedNoise noise(seed, {61});
  std::vector<Eigen::Vector2d> out;
  for (int i = 0; i < 24; ++i) {
    const double angle = core::kTwoPi * i / 24.0;
    const double r = 25.0 + 4e-3 * std::cos(2.0 * angle) + 2e-3 * noise.normal();
    out.emplace_back(10.0 + r * std::cos(angle), -4.0 + r * std::sin(angle));
  }
  return out;
}

/// Four such sections, 20 mm apart.
std::vector<Eigen::Vector3d> surface(std::uint64_t seed) {
  std::vector<Eigen::Vector3d> out;
  for (int layer = 0; layer < 4; ++layer) {
    for (const Eigen::Vector2d& p : section(4 * seed + static_cast<std::uint64_t>(layer)))
      out.emplace_back(p.x(), p.y(), 20.0 * layer);
  }
  return out;
}

/// A one-sided reference as a stated zone.
template <class Fit>
StatedZone circumscribed(const Fit& fit) {
  return {fit.radius_mm - fit.deviation_mm, fit.radius_mm, fit.contacts, {}};
}
template <class Fit>
StatedZone inscribed(const Fit& fit) {
  return {fit.radius_mm, fit.radius_mm + fit.deviation_mm, {}, fit.contacts};
}

/// What has no certificate has nothing to check.
template <class Fit>
bool certified(const Fit& fit) {
  return fit.certificate.kind != Certificate::Kind::kNone;
}

TEST(CertificateCheck, HoldsForOneSidedReferencesOfCirclesAndCylinders) {
  int cylinders = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const auto flat = section(seed);
    const auto mc = min_circumscribed_circle(flat);
    const auto mi = max_inscribed_circle(flat);
    ASSERT_TRUE(mc && mi);
    EXPECT_EQ(check_zone(flat, mc->center_mm, circumscribed(*mc)).fault, "");
    EXPECT_EQ(check_zone(flat, mi->center_mm, inscribed(*mi)).fault, "");
    EXPECT_LT(check_zone(flat, mc->center_mm, circumscribed(*mc)).gap_mm, 1e-8);
    EXPECT_LT(check_zone(flat, mi->center_mm, inscribed(*mi)).gap_mm, 1e-8);
    const auto points = surface(seed);
    const auto ring = min_circumscribed_cylinder(points, Eigen::Vector3d::UnitZ());
    const auto plug = max_inscribed_cylinder(points, Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(ring && plug);
    if (certified(*ring)) {
      ++cylinders;
      EXPECT_EQ(check_zone(points, ring->axis, circumscribed(*ring)).fault, "");
    }
    if (certified(*plug)) {
      ++cylinders;
      EXPECT_EQ(check_zone(points, plug->axis, inscribed(*plug)).fault, "");
    }
  }
  EXPECT_GE(cylinders, 38);
}

TEST(CertificateCheck, FindsEveryWrongStatementOfOneSide) {
  const auto points = section(3);
  const auto mi = max_inscribed_circle(points);
  ASSERT_TRUE(mi.has_value());
  StatedZone large = inscribed(*mi);
  large.inner_radius_mm += 1e-6;
  EXPECT_NE(check_zone(points, mi->center_mm, large).fault.find("outside"), std::string::npos);
  StatedZone small = inscribed(*mi);
  small.inner_radius_mm -= 1e-6;
  EXPECT_NE(check_zone(points, mi->center_mm, small).fault.find("off its radius"),
            std::string::npos);
  auto contacts = mi->contacts;
  contacts.front().multiplier += 0.01;
  StatedZone heavy = inscribed(*mi);
  heavy.inner = contacts;
  EXPECT_NE(check_zone(points, mi->center_mm, heavy).fault.find("multipliers"), std::string::npos);
  contacts.back().multiplier -= 0.01;
  EXPECT_NE(check_zone(points, mi->center_mm, heavy).fault.find("balance"), std::string::npos);
}

TEST(CertificateCheck, TheOtherSideOfAOneSidedReferenceClaimsNothing) {
  const auto points = section(4);
  const auto mc = min_circumscribed_circle(points);
  ASSERT_TRUE(mc.has_value());
  StatedZone zone = circumscribed(*mc);
  zone.inner_radius_mm = mc->radius_mm - 1e-6;  // most points lie below it
  EXPECT_EQ(check_zone(points, mc->center_mm, zone).fault, "");
}

TEST(CertificateCheck, WhatIsNotANumberOrNotAPointDoesNotPass) {
  const auto points = section(5);
  const auto zone = min_zone_circle(points);
  ASSERT_TRUE(zone.has_value());
  const StatedZone right{zone->inner_radius_mm, zone->outer_radius_mm, zone->outer, zone->inner};
  ASSERT_EQ(check_zone(points, zone->center_mm, right).fault, "");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  StatedZone wrong = right;
  wrong.outer_radius_mm = nan;
  EXPECT_NE(check_zone(points, zone->center_mm, wrong).fault, "");
  auto contacts = zone->outer;
  contacts.front().multiplier = nan;
  wrong = right;
  wrong.outer = contacts;
  EXPECT_NE(check_zone(points, zone->center_mm, wrong).fault, "");
  contacts.front() = {points.size(), 0.5};
  EXPECT_NE(check_zone(points, zone->center_mm, wrong).fault.find("row 24 of 24"),
            std::string::npos);
}

}  // namespace
}  // namespace rondure::fit
