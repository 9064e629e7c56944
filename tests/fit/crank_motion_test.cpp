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
    EXPECT_NEAR(test::contact_angle_rad(geometry, row.alpha_deg * kDegree) / kDegree, row.beta_deg,
                5e-7);
  }
}

TEST(CrankMotion, AnglesGoThereAndBackOverSeveralTurns) {
  for (const double crank : {1.0, 49.0, 200.0, 324.0}) {
    SCOPED_TRACE(crank);
    CrankGeometry geometry;
    geometry.crank_radius_mm = crank;
    for (double alpha = -10.0; alpha < 10.0; alpha += 0.01) {
      const double beta = test::contact_angle_rad(geometry, alpha);
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

}  // namespace
}  // namespace rondure::fit
