#include "fit/contour/crank_motion.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/fit/contour_cases.h"

namespace rondure::fit {
namespace {

using core::kDegree;

TEST(CrankMotion, GivesTheTableOfTheSpecification) {
  struct Row {
    double alpha_deg, d_mm, beta_deg;
  };
  const CrankGeometry geometry;
  for (const Row& row : {Row{0, 373.44, 0}, Row{30, 365.948867, 34.330798},
                         Row{45, 357.232816, 51.130534}, Row{60, 346.152862, 67.515555},
                         Row{90, 320.718434, 98.686590}, Row{120, 297.152862, 127.515555},
                         Row{150, 281.078377, 154.330798}, Row{180, 275.44, 180}}) {
    SCOPED_TRACE(row.alpha_deg);
    EXPECT_NEAR(wheel_position_mm(geometry, row.alpha_deg * kDegree), row.d_mm, 5e-7);
    EXPECT_NEAR(contact_angle_rad(geometry, row.alpha_deg * kDegree) / kDegree, row.beta_deg, 5e-7);
  }
}

TEST(CrankMotion, GivesTheSensitivitiesOfTheSpecification) {
  struct Row {
    double beta_deg, x, c_mm;
  };
  for (const Row& row : {Row{0, 1, 0}, Row{45, 0.995377, 34.648}, Row{90, 0.988787, 49},
                         Row{135, 0.992928, 34.648}, Row{180, 1, 0}, Row{225, 0.992928, -34.648},
                         Row{270, 0.988787, -49}, Row{315, 0.995377, -34.648}}) {
    SCOPED_TRACE(row.beta_deg);
    const auto out = contour_sensitivity(CrankGeometry{}, row.beta_deg * kDegree);
    EXPECT_NEAR(out.x, row.x, 5e-7);
    EXPECT_NEAR(out.c_mm, row.c_mm, 5e-4);
  }
}

TEST(CrankMotion, AnglesGoThereAndBackOverSeveralTurns) {
  for (const double crank : {1.0, 49.0, 200.0, 324.0}) {
    SCOPED_TRACE(crank);
    CrankGeometry geometry;
    geometry.crank_radius_mm = crank;
    for (double alpha = -10.0; alpha < 10.0; alpha += 0.01) {
      const double beta = contact_angle_rad(geometry, alpha);
      EXPECT_NEAR(command_angle_rad(geometry, beta), alpha, 1e-9);
      EXPECT_NEAR(pressure_angle_rad(geometry, beta), beta - alpha, 1e-9);
    }
  }
}

TEST(CrankMotion, TheWheelStaysTangentToThePin) {
  const CrankGeometry geometry;
  for (double alpha = 0.0; alpha < core::kTwoPi; alpha += 0.01) {
    const double d = wheel_position_mm(geometry, alpha);
    const double x = d * std::cos(alpha) - geometry.crank_radius_mm;
    EXPECT_NEAR(std::hypot(x, d * std::sin(alpha)), geometry.center_distance_mm(), 1e-12 * 400.0);
  }
}

TEST(CrankMotion, RefusesAPinTheWheelCannotFollow) {
  CrankGeometry geometry;
  geometry.crank_radius_mm = 324.44;
  EXPECT_EQ(check_geometry(geometry).error().code, core::Code::kOutOfRange);
  geometry.crank_radius_mm = 324.4;
  EXPECT_TRUE(check_geometry(geometry));
  geometry.pin_radius_mm = 0.0;
  EXPECT_NE(check_geometry(geometry).error().what.find("pin radius is 0 mm"), std::string::npos);
  geometry.pin_radius_mm = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check_geometry(geometry).error().code, core::Code::kNotFinite);
}

TEST(CrankMotion, CompensationTakesTheFollowingPartAway) {
  const CrankGeometry geometry;
  auto errors = test::spec_errors(1440);
  const auto before = test::spec_following(1.0, 1440);
  const auto correction = x_compensation_mm(geometry, before.error_mm, 1440);
  for (std::size_t i = 0; i < 1440; ++i) errors.x_mm[i] += correction[i];
  auto ground = ground_contour(geometry, errors).value();
  for (double& r : ground.r_mm) r -= geometry.pin_radius_mm;
  const auto after = contour_error(ground.r_mm, geometry.pin_radius_mm).value();
  EXPECT_GT(before.peak_to_valley_mm, 7e-3);
  EXPECT_LT(after.peak_to_valley_mm, 0.25e-3);  // what the filter took from f is not corrected
}

}  // namespace
}  // namespace rondure::fit
