#include "fit/contour/crank_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "tests/fit/contour_cases.h"

namespace rondure::fit {
namespace {

using core::kDegree;
using core::kMicrometre;

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

// K-1 and K-2 of analyses_uncertainty 13: the contour of exact traces, its correction at every
// 30 deg with its mean, and the contour that is ground again.
struct GroundAgain {
  CrankGeometry geometry;
  ContourError before = test::spec_following(1.0, 1440, {});
  std::vector<double> correction_mm = x_compensation_mm(geometry, before.error_mm, 1440);

  /// f with the correction, `times` it, read at `sense` times C and late by so much.
  [[nodiscard]] ContourError after(double times = 1.0, double sense = 1.0,
                                   double late_deg = 0.0) const {
    auto errors = test::spec_errors(1440);
    for (std::size_t i = 0; i < 1440; ++i) {
      const double row = sense * (static_cast<double>(i) - 4.0 * late_deg) + 2880.0;
      const auto low = static_cast<std::size_t>(row);
      const double share = row - static_cast<double>(low);
      errors.x_mm[i] += times * ((1.0 - share) * correction_mm[low % 1440] +
                                 share * correction_mm[(low + 1) % 1440]);
    }
    auto r_mm = ground_contour(geometry, errors).value().r_mm;
    for (double& r : r_mm) r -= geometry.pin_radius_mm;
    return contour_error(r_mm, geometry.pin_radius_mm).value();
  }
};

TEST(CrankMotion, TheWorkedCaseHasTheDigitsOfTheSpecification) {
  const GroundAgain pin;
  EXPECT_NEAR(pin.before.peak_to_valley_mm / kMicrometre, 7.043077, 5e-7);
  EXPECT_NEAR(pin.before.rms_mm / kMicrometre, 2.015810, 5e-7);
  std::vector<double> first(1440);
  for (std::size_t m = 0; m < 1440; ++m) {
    const double beta = test::turn_angle(m, 1440);
    const double alpha = command_angle_rad(pin.geometry, beta);
    const auto sensitivity = contour_sensitivity(pin.geometry, beta);
    first[m] = sensitivity.x * test::spec_x_um(alpha) * kMicrometre +
               sensitivity.c_mm * test::spec_c_mdeg(alpha) * 1e-3 * kDegree;
  }
  const auto linear = contour_error(first, pin.geometry.pin_radius_mm).value();
  double off_mm = 0.0;
  for (std::size_t m = 0; m < 1440; ++m) {
    off_mm = std::max(off_mm, std::abs(linear.error_mm[m] - pin.before.error_mm[m]));
  }
  EXPECT_NEAR(off_mm / kMicrometre, 0.0073, 5e-5);
}

TEST(CrankMotion, TheCorrectionOfTheWorkedCaseHasTheDigitsOfTheSpecification) {
  const GroundAgain pin;
  const std::vector<double> rows_um = {-3.25384, -1.26257, 2.65840,  0.35184, 1.08282, 0.19146,
                                       -0.67190, -2.67212, -2.64509, 3.37641, 2.81066, -0.17973};
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_NEAR(pin.correction_mm[120 * i] / kMicrometre, rows_um[i], 5.1e-6) << 30 * i;
  }
  const ContourError again = pin.after();
  EXPECT_NEAR(again.peak_to_valley_mm / kMicrometre, 0.0834, 5e-5);
  EXPECT_NEAR(again.rms_mm / kMicrometre, 0.0152, 5e-5);
  const auto pv_um = [&](double times, double sense, double late_deg) {
    return pin.after(times, sense, late_deg).peak_to_valley_mm / kMicrometre;
  };
  EXPECT_NEAR(pv_um(1.0, 1.0, 0.3), 0.181, 5e-4);
  EXPECT_NEAR(pv_um(1.0, 1.0, 1.2), 0.636, 5e-4);
  EXPECT_NEAR(pv_um(-1.0, 1.0, 0.0), 14.040, 5e-4);
  EXPECT_NEAR(pv_um(1.0, -1.0, 0.0), 9.775, 5e-4);
}

}  // namespace
}  // namespace rondure::fit
