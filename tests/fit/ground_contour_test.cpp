#include "fit/contour/ground_contour.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/units.h"
#include "fit/contour/error.h"
#include "tests/fit/contour_cases.h"

namespace rondure::fit {
namespace {

using core::kDegree;
using core::kMicrometre;

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double out = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

/// The envelope by its definition: every position, for every angle.
double envelope_by_hand(const std::vector<double>& x, const std::vector<double>& y, double wheel,
                        double beta) {
  double least = std::numeric_limits<double>::infinity();
  const double c = std::cos(beta);
  const double s = std::sin(beta);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double along = x[i] * c + y[i] * s;
    const double across = y[i] * c - x[i] * s;
    if (along <= 0.0 || std::abs(across) > wheel) continue;
    least = std::min(least, along - std::sqrt(wheel * wheel - across * across));
  }
  return least;
}

// Four cells of the specification's table are misprinted: x of sample 0 (324.444574006; d_a
// cos(alpha)
// - R of its own row gives 324.443574006), beta of 50 (67.517375106), x of 75 (-49.001125994) and y
// of 200 (-257.341531567; not on the circle d_a). Here stand the values of its formulas, found by
// an independent program.
TEST(GroundContour, GivesTheTableOfTheWorkedExample) {
  struct Row {
    std::size_t sample;
    double x_mm, y_mm, beta_deg, r_mm;
  };
  const CrankGeometry geometry;
  const auto errors = test::spec_errors();
  const auto path = wheel_path(geometry, errors).value();
  const auto curve = parallel_curve(path, geometry.wheel_radius_mm);
  for (const Row& row : {Row{0, 324.443574006, 0.013918856, 0.008107564, 24.563574434},
                         Row{25, 267.919930839, 182.979486455, 34.323049182, 24.561954744},
                         Row{50, 124.079976652, 299.773852813, 67.517376104, 24.558289132},
                         Row{75, -49.001125999, 320.718996772, 98.685206894, 24.560726861},
                         Row{100, -197.578456208, 257.340206385, 127.504113367, 24.559868931},
                         Row{150, -324.441141554, -0.000140903, 180.004770593, 24.561141645},
                         Row{200, -197.581230914, -257.341532161, 232.461038007, 24.562611777},
                         Row{225, -48.992433352, -320.715954358, 261.305980124, 24.556406872}}) {
    SCOPED_TRACE(row.sample);
    EXPECT_NEAR(path.x_mm[row.sample], row.x_mm, 1.1e-9);
    EXPECT_NEAR(path.y_mm[row.sample], row.y_mm, 1.1e-9);
    EXPECT_NEAR(curve.beta_rad[row.sample] / kDegree, row.beta_deg, 1.1e-9);
    EXPECT_NEAR(curve.r_mm[row.sample], row.r_mm, 1.1e-9);
  }
  EXPECT_NEAR(errors.c_rad[25] / kDegree, 0.770031e-3, 5e-10);
  EXPECT_NEAR(errors.x_mm[225], -2.479073e-3, 5e-10);
}

TEST(GroundContour, ParallelCurveIsTheEnvelopeOfEveryWheelPosition) {
  const CrankGeometry geometry;
  constexpr std::size_t kFine = 86'400;
  const auto ground = ground_contour(geometry, test::spec_errors(300)).value();
  const auto fine = wheel_path(geometry, test::spec_errors(kFine)).value();
  ASSERT_FALSE(ground.undercut);
  double worst = 0.0;
  for (std::size_t m = 0; m < 1440; m += 15) {
    const double by_hand =
        envelope_by_hand(fine.x_mm, fine.y_mm, geometry.wheel_radius_mm, test::turn_angle(m, 1440));
    worst = std::max(worst, std::abs(by_hand - ground.r_mm[m]));
  }
  EXPECT_LT(worst, 1e-4 * kMicrometre);
}

TEST(GroundContour, QuickEnvelopeIsTheOneOfLookingAtEverything) {
  const CrankGeometry geometry;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    const auto errors = test::random_errors(seed, 200);
    const auto path = wheel_path(geometry, errors).value();
    const auto ground = ground_contour(geometry, errors, {.samples = 360}).value();
    const auto envelope = envelope_radii_mm(path, geometry.wheel_radius_mm, 360);
    EXPECT_FALSE(ground.undercut);
    EXPECT_LT(largest_difference(envelope, ground.r_mm), 1e-4 * kMicrometre);
  }
}

/// df/du of a periodic function at u = 2 pi i / n, n even: that of its trigonometric interpolant.
std::vector<double> periodic_derivative(const std::vector<double>& f) {
  const std::size_t n = f.size();
  std::vector<double> out(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 1; k < n; ++k) {
      const double weight = (k % 2 == 0 ? 0.5 : -0.5) / std::tan(0.5 * test::turn_angle(k, n));
      out[i] += weight * f[(i + n - k) % n];
    }
  }
  return out;
}

// Section 3: rho(theta) of the wheel centre and its derivative, without x' and y'.
TEST(GroundContour, ParallelCurveIsThatOfThePolarForm) {
  const CrankGeometry geometry;
  const double wheel = geometry.wheel_radius_mm;
  const auto path = wheel_path(geometry, test::spec_errors()).value();
  const auto curve = parallel_curve(path, wheel);
  const std::size_t n = path.x_mm.size();
  std::vector<double> rho;
  std::vector<double> lead;  // theta minus the angle of the sample: periodic
  for (std::size_t i = 0; i < n; ++i) {
    rho.push_back(std::hypot(path.x_mm[i], path.y_mm[i]));
    const double theta = std::atan2(path.y_mm[i], path.x_mm[i]);
    lead.push_back(std::remainder(theta - test::turn_angle(i, n), core::kTwoPi));
  }
  const auto rho_step = periodic_derivative(rho);
  const auto lead_step = periodic_derivative(lead);
  for (std::size_t i = 0; i < n; ++i) {
    SCOPED_TRACE(i);
    const double slope = rho_step[i] / (1.0 + lead_step[i]);
    const double q = std::hypot(rho[i], slope);
    // rho^2 + Rgw^2 - 2 Rgw rho^2 / q without its cancellation.
    const double square = (rho[i] - wheel) * (rho[i] - wheel) +
                          2.0 * wheel * rho[i] * slope * slope / (q * (q + rho[i]));
    const double theta = lead[i] + test::turn_angle(i, n);
    const double beta = theta + std::atan2(wheel * slope, rho[i] * (q - wheel));
    EXPECT_NEAR(curve.r_mm[i], std::sqrt(square), 1e-9 * kMicrometre);
    EXPECT_NEAR(std::remainder(curve.beta_rad[i] - beta, core::kTwoPi), 0.0, 1e-10);
  }
}

TEST(GroundContour, CentralDifferencesAreAsFarOffAsTheSpecificationSays) {
  const CrankGeometry geometry;
  const auto path = wheel_path(geometry, test::spec_errors()).value();
  const auto cartesian = parallel_curve(path, geometry.wheel_radius_mm);
  const auto coarse = parallel_curve(path, geometry.wheel_radius_mm, ParallelForm::kDifferences);
  const double off = largest_difference(cartesian.r_mm, coarse.r_mm);
  EXPECT_NEAR(off / kMicrometre, 0.010, 5e-4);  // section 3
}

TEST(GroundContour, IdealMotionGrindsACircle) {
  for (const double crank : {5.0, 49.0, 150.0}) {
    SCOPED_TRACE(crank);
    CrankGeometry geometry;
    geometry.crank_radius_mm = crank;
    const AxisErrors none = {std::vector<double>(300, 0.0), std::vector<double>(300, 0.0)};
    const auto ground = ground_contour(geometry, none).value();
    for (const double r : ground.r_mm) EXPECT_NEAR(r, geometry.pin_radius_mm, 1e-10);
    EXPECT_NEAR(ground.regularity, geometry.pin_radius_mm / geometry.center_distance_mm(), 1e-6);
  }
}

TEST(GroundContour, ShowsUndercutWhereTheRippleIsTooSteep) {
  // a (k^2 - 1) = r Lc / Rgw = 26.57 mm: 10.63 um at k = 50.
  const CrankGeometry geometry;
  const auto ripple = [&](double um, std::size_t count = 1440) {
    AxisErrors errors = {std::vector<double>(count, 0.0), {}};
    for (std::size_t i = 0; i < count; ++i) {
      const double alpha = test::turn_angle(i, count);
      const double beta = contact_angle_rad(geometry, alpha);
      errors.x_mm.push_back(um * kMicrometre * std::cos(50.0 * beta) / std::cos(beta - alpha));
    }
    return errors;
  };
  EXPECT_FALSE(ground_contour(geometry, ripple(10.0)).value().undercut);
  const auto cut = ground_contour(geometry, ripple(30.0)).value();
  EXPECT_TRUE(cut.undercut);
  EXPECT_LT(cut.regularity, 0.0);
  const auto fine = wheel_path(geometry, ripple(30.0, 28'800)).value();
  for (std::size_t m = 0; m < 1440; m += 55) {
    EXPECT_NEAR(
        envelope_by_hand(fine.x_mm, fine.y_mm, geometry.wheel_radius_mm, test::turn_angle(m, 1440)),
        cut.r_mm[m], 1e-3 * kMicrometre);
  }
}

TEST(GroundContour, TurnsWithTheMirrorWhenTheSenseTurns) {
  // alpha -> -alpha, dalpha -> -dalpha mirrors the contour.
  const CrankGeometry geometry;
  const auto errors = test::random_errors(3, 240);
  AxisErrors mirrored = errors;
  std::reverse(mirrored.c_rad.begin() + 1, mirrored.c_rad.end());
  std::reverse(mirrored.x_mm.begin() + 1, mirrored.x_mm.end());
  for (double& c : mirrored.c_rad) c = -c;
  auto a = ground_contour(geometry, errors).value().r_mm;
  const auto b = ground_contour(geometry, mirrored).value().r_mm;
  std::reverse(a.begin() + 1, a.end());
  EXPECT_LT(largest_difference(a, b), 1e-9);
}

TEST(GroundContour, FirstOrderIsCloseToTheEnvelope) {
  const CrankGeometry geometry;
  std::vector<double> first(1440);
  for (std::size_t m = 0; m < 1440; ++m) {
    const double beta = test::turn_angle(m, 1440);
    const double alpha = command_angle_rad(geometry, beta);
    const auto sensitivity = contour_sensitivity(geometry, beta);
    first[m] = sensitivity.x * test::spec_x_um(alpha) * kMicrometre +
               sensitivity.c_mm * test::spec_c_mdeg(alpha) * 1e-3 * kDegree;
  }
  auto ground = ground_contour(geometry, test::spec_errors(1440)).value().r_mm;
  for (double& r : ground) r -= geometry.pin_radius_mm;
  EXPECT_NEAR(largest_difference(first, ground) / kMicrometre, 0.009, 5e-4);  // section 5
}

// Every other position of the wheel is a kilometre away: the ones between cut only parts of the
// turn.
/// A turn whose X is corrected by what it ground.
struct CorrectedTurn {
  AxisErrors errors;
  ContourError f = {};

  explicit CorrectedTurn(double c_scale = 1.0) : errors(test::spec_errors(300, c_scale)) {
    grind();
  }
  void grind() {
    const CrankGeometry geometry;
    auto r = ground_contour(geometry, errors, {.refine = false}).value().r_mm;
    for (double& v : r) v -= geometry.pin_radius_mm;
    f = contour_error(r, geometry.pin_radius_mm).value();
  }
  /// Adds -f(beta) / cos(eta) to X, sin(eta) = R sin(alpha) / Lc, beta = alpha + eta; taken at
  /// alpha plus an angle. A cubic lies between the points of f.
  void correct(const std::vector<double>& by_mm, double times = 1.0, double turned_rad = 0.0) {
    const auto count = static_cast<double>(by_mm.size());
    for (std::size_t i = 0; i < errors.x_mm.size(); ++i) {
      const double alpha = test::turn_angle(i, errors.x_mm.size()) + turned_rad;
      const double eta = std::asin(49.0 * std::sin(alpha) / (299.88 + 24.56));
      const double place = std::fmod((alpha + eta) / core::kTwoPi + 1.0, 1.0) * count;
      const auto at = [&](double k) {
        return by_mm[static_cast<std::size_t>(std::fmod(std::floor(place) + k + count, count))];
      };
      const double t = place - std::floor(place);
      const double slope = 0.5 * (at(1) - at(-1));
      const double square = at(-1) - 2.5 * at(0) + 2.0 * at(1) - 0.5 * at(2);
      const double cube = 1.5 * (at(0) - at(1)) + 0.5 * (at(2) - at(-1));
      errors.x_mm[i] -= times * (at(0) + t * (slope + t * (square + t * cube))) / std::cos(eta);
    }
    grind();
  }
};

// Machine cell 4.4. An independent program gives 0.0834, 0.0132, 0.0035; the text prints 0.004.
TEST(GroundContour, IsTakenAwayByRepeatedCorrection) {
  CorrectedTurn turn;
  for (const double left_um : {0.0834, 0.0132, 0.0035}) {
    turn.correct(turn.f.error_mm);
    EXPECT_NEAR(turn.f.peak_to_valley_mm / kMicrometre, left_um, 5e-4);
  }
  CorrectedTurn wrong;
  wrong.correct(wrong.f.error_mm, -1.0);
  EXPECT_NEAR(wrong.f.peak_to_valley_mm / kMicrometre, 14.04, 5.1e-3);
  CorrectedTurn turned;  // the table, by one of 300 samples
  turned.correct(turned.f.error_mm, 1.0, -1.2 * kDegree);
  EXPECT_NEAR(turned.f.peak_to_valley_mm / kMicrometre, 0.64, 5.1e-3);
}

TEST(GroundContour, OfFourPartsIsTakenAwayByTheCorrectionOfTheirMean) {
  std::vector<double> mean_mm(1440, 0.0);
  for (const double scale : test::kSpecCScale) {
    const CorrectedTurn part(scale);
    for (std::size_t m = 0; m < mean_mm.size(); ++m) mean_mm[m] += part.f.error_mm[m] / 4.0;
  }
  const double before_um[] = {2.016, 2.040, 1.992, 2.025};
  const double after_um[] = {0.015, 0.033, 0.030, 0.019};
  for (std::size_t i = 0; i < 4; ++i) {
    SCOPED_TRACE(i);
    CorrectedTurn part(test::kSpecCScale[i]);
    EXPECT_NEAR(part.f.rms_mm / kMicrometre, before_um[i], 5.1e-4);
    part.correct(mean_mm);
    EXPECT_NEAR(part.f.rms_mm / kMicrometre, after_um[i], 5.1e-4);
  }
}

TEST(GroundContour, RefusesErrorsThatLeaveAnglesWithoutARadius) {
  auto errors = test::spec_errors(300);
  for (std::size_t i = 0; i < errors.x_mm.size(); i += 2) errors.x_mm[i] = 1e6;
  for (std::size_t i = 0; i < 150; ++i) errors.x_mm[i] = 1e6;
  const auto refused = ground_contour(CrankGeometry{}, errors);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Code::kOutOfRange);
  EXPECT_NE(refused.error().what.find("errors of X reach 1e+06 mm"), std::string::npos)
      << refused.error().what;
}

TEST(GroundContour, RefusesWhatIsNoMotion) {
  const CrankGeometry geometry;
  auto errors = test::spec_errors();
  errors.x_mm.pop_back();
  EXPECT_EQ(ground_contour(geometry, errors).error().code, core::Code::kMeaning);
  EXPECT_EQ(ground_contour(geometry, test::spec_errors(15)).error().code,
            core::Code::kTooFewPoints);
  errors = test::spec_errors();
  errors.x_mm[7] = std::numeric_limits<double>::quiet_NaN();
  const auto not_finite = ground_contour(geometry, errors);
  EXPECT_EQ(not_finite.error().code, core::Code::kNotFinite);
  EXPECT_NE(not_finite.error().what.find("sample 7 "), std::string::npos);
  errors.x_mm[7] = -400.0;
  EXPECT_EQ(ground_contour(geometry, errors).error().code, core::Code::kOutOfRange);
  CrankGeometry large;
  large.crank_radius_mm = 400.0;
  EXPECT_EQ(ground_contour(large, test::spec_errors()).error().code, core::Code::kOutOfRange);
  EXPECT_EQ(ground_contour(geometry, test::spec_errors(), {.samples = 8}).error().code,
            core::Code::kBadOption);
}

}  // namespace
}  // namespace rondure::fit
