#include "fit/contour/error.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <utility>

#include "core/numbers.h"
#include "core/statistics.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/circle.h"
#include "fit/profiles/closed_profile.h"
#include "fit/profiles/internal/dft.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::fit {
namespace {

double angle_of(std::size_t m, std::size_t count) {
  return core::kTwoPi * static_cast<double>(m) / static_cast<double>(count);
}

core::Result<void> check_values(std::span<const double> deviation_mm) {
  if (deviation_mm.size() < kLeastContourPoints) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "a contour of {} points; at least {} are needed", deviation_mm.size(),
                           kLeastContourPoints);
  }
  for (std::size_t i = 0; i < deviation_mm.size(); ++i) {
    if (core::is_measurable(deviation_mm[i])) continue;
    return core::fail_with(core::Code::kNotFinite,
                           "row {} is {} mm; a finite number up to {:g} is needed", i,
                           deviation_mm[i], core::kGreatestNumber);
  }
  return {};
}

/// Subtracts mean, cos and sin.
void take_limacon(ContourError& out, double nominal_mm) {
  auto f = spectrum(out.error_mm);
  const auto n = static_cast<double>(out.error_mm.size());
  out.base_radius_mm = nominal_mm + f[0].real() / n;
  out.base_center_mm = {2.0 * f[1].real() / n, -2.0 * f[1].imag() / n};
  f[0] = f[1] = 0.0;
  out.error_mm = series_of(f, out.error_mm.size());
}

/// Subtracts the least-squares circle of the points, and counts angles about its centre.
core::Result<void> take_circle(ContourError& out, double nominal_mm) {
  const std::size_t n = out.error_mm.size();
  std::vector<Eigen::Vector2d> points(n);
  for (std::size_t m = 0; m < n; ++m) {
    const double angle = angle_of(m, n);
    points[m] = (nominal_mm + out.error_mm[m]) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  TRY(const auto circle, ls_circle(points));
  out.base_radius_mm = circle.radius_mm;
  out.base_center_mm = circle.center_mm;
  std::vector<double> theta(n);
  std::vector<double> residual(n);
  for (std::size_t m = 0; m < n; ++m) {
    const Eigen::Vector2d arm = points[m] - circle.center_mm;
    theta[m] = std::atan2(arm.y(), arm.x());
    residual[m] = arm.norm() - circle.radius_mm;
  }
  TRY(const auto ordered, ordered_profile(theta, residual));
  const PeriodicSpline spline(ordered.theta_rad, ordered.r_mm);
  for (std::size_t m = 0; m < n; ++m) out.error_mm[m] = spline(angle_of(m, n));
  const double mean = core::mean(out.error_mm);
  for (double& v : out.error_mm) v -= mean;
  return {};
}

}  // namespace

double ContourError::crest_rad() const {
  const auto at = std::ranges::max_element(error_mm) - error_mm.begin();
  return angle_of(static_cast<std::size_t>(at), error_mm.size());
}

double ContourError::valley_rad() const {
  const auto at = std::ranges::min_element(error_mm) - error_mm.begin();
  return angle_of(static_cast<std::size_t>(at), error_mm.size());
}

double peak_to_valley(std::span<const double> curve) {
  return curve.empty() ? 0.0 : column_extremes(curve).width();
}

core::Result<ContourError> contour_error(std::span<const double> deviation_mm, double nominal_mm,
                                         const ContourErrorOptions& options) {
  TRY_DO(check_values(deviation_mm));
  ContourError out;
  out.error_mm.assign(deviation_mm.begin(), deviation_mm.end());
  if (options.base == BaseCircle::kLimacon) {
    take_limacon(out, nominal_mm);
  } else if (auto taken = take_circle(out, nominal_mm); !taken) {
    return core::fail(taken.error());
  }
  if (!options.filtered_already) {
    TRY(auto filtered, filter_closed(out.error_mm, options.filter));
    out.error_mm = std::move(filtered.r_mm);
  }
  out.peak_to_valley_mm = peak_to_valley(out.error_mm);
  out.rms_mm = core::root_mean_square(out.error_mm);
  return out;
}

std::vector<Harmonic> contour_harmonics(std::span<const double> error_mm, int highest) {
  const auto f = spectrum(error_mm);
  const double scale = 2.0 / static_cast<double>(error_mm.size());
  const int last = std::min(highest, static_cast<int>((error_mm.size() - 1) / 2));
  std::vector<Harmonic> out;
  for (int k = 2; k <= last; ++k) {
    const auto c = scale * f[static_cast<std::size_t>(k)];
    Harmonic one{k, std::abs(c), std::nullopt};
    if (one.amplitude_mm > 0.0) one.phase_rad = -std::arg(c);
    out.push_back(one);
  }
  return out;
}

std::vector<double> contour_coefficients(std::span<const double> error_mm, int highest) {
  const auto f = spectrum(error_mm);
  const double scale = 2.0 / static_cast<double>(error_mm.size());
  std::vector<double> out;
  for (int k = 2; k <= highest; ++k) {
    const auto c = scale * f[static_cast<std::size_t>(k)];
    out.push_back(c.real());
    out.push_back(-c.imag());
  }
  return out;
}

std::vector<double> contour_of(std::span<const double> coefficients_mm, std::size_t samples) {
  Spectrum half(samples / 2 + 1);
  const double scale = 0.5 * static_cast<double>(samples);
  for (std::size_t j = 0; j + 1 < coefficients_mm.size(); j += 2) {
    half[j / 2 + 2] = scale * Complex(coefficients_mm[j], -coefficients_mm[j + 1]);
  }
  return series_of(half, samples);
}

std::vector<double> turned_curve(std::span<const double> curve, double angle_rad) {
  auto f = spectrum(curve);
  for (std::size_t k = 0; k < f.size(); ++k) {
    f[k] *= std::polar(1.0, -static_cast<double>(k) * angle_rad);
  }
  return series_of(f, curve.size());
}

}  // namespace rondure::fit
