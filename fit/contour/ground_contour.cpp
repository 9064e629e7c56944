#include "fit/contour/ground_contour.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

#include "core/numbers.h"
#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/profiles/internal/dft.h"
#include "fit/profiles/periodic_spline.h"

namespace rondure::fit {
namespace {

/// The Fourier series of a periodic series at `times` as many places.
std::vector<double> refined_series(std::span<const double> series, std::size_t times) {
  auto half = spectrum(series);
  if (series.size() % 2 == 0 && times > 1) half.back() *= 0.5;  // now one of two equal terms
  half.resize(series.size() * times / 2 + 1);
  auto out = series_of(half, series.size() * times);
  for (double& v : out) v *= static_cast<double>(times);
  return out;
}

/// Wheel positions by their polar angle about the pin centre.
struct Positions {
  std::vector<double> theta;  ///< In [0, 2 pi), ascending except for C axis ripple.
  std::vector<double> rho;
  double least_rho = std::numeric_limits<double>::infinity();
  double wheel = 0.0;

  /// Distance from the pin centre to a wheel circle along a ray at an angle D from the wheel
  /// centre; infinite if the ray misses it.
  [[nodiscard]] static double reach(double rho, double wheel, double off) {
    const double across = rho * std::sin(off);
    const double along = rho * std::cos(off);
    if (along <= 0.0 || std::abs(across) > wheel) return std::numeric_limits<double>::infinity();
    return along - std::sqrt(wheel * wheel - across * across);
  }
  [[nodiscard]] double reach(std::size_t i, double beta) const {
    return reach(rho[i], wheel, std::remainder(beta - theta[i], core::kTwoPi));
  }
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 < rho.size() ? i + 1 : 0; }
  [[nodiscard]] std::size_t before(std::size_t i) const { return i > 0 ? i - 1 : rho.size() - 1; }
};

Positions positions_of(const GrindingPath& path, double wheel, std::size_t oversampling) {
  const auto [x, y] = refined(path, oversampling);
  Positions out;
  out.wheel = wheel;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double theta = std::atan2(y[i], x[i]);
    out.theta.push_back(theta < 0.0 ? theta + core::kTwoPi : theta);
    out.rho.push_back(std::hypot(x[i], y[i]));
    out.least_rho = std::min(out.least_rho, out.rho.back());
  }
  return out;
}

/// Least value of the parabola through three neighbours, of which the middle one is the least.
double parabola_least(double before, double middle, double after) {
  const double bend = before - 2.0 * middle + after;
  const double slope = 0.5 * (after - before);
  if (!std::isfinite(bend) || bend <= 0.0) return middle;
  return middle - 0.5 * slope * slope / bend;
}

/// Finds the least reach in one direction after the other.
class Search {
 public:
  explicit Search(const Positions& at) : at_(at) {
    for (std::size_t i = 0; i < at.rho.size(); ++i) slack_ = std::max(slack_, step_after(i));
  }

  /// @param beta  Not far after the previous one.
  double least(double beta) {
    const std::size_t n = at_.rho.size();
    for (std::size_t step = 0; step < n && off(at_.after(nearest_), beta) < off(nearest_, beta);
         ++step) {
      nearest_ = at_.after(nearest_);
    }
    best_ = nearest_;
    least_ = at_.reach(nearest_, beta);
    look(beta, [&](std::size_t i) { return at_.after(i); });
    look(beta, [&](std::size_t i) { return at_.before(i); });
    return parabola_least(at_.reach(at_.before(best_), beta), least_,
                          at_.reach(at_.after(best_), beta));
  }

 private:
  [[nodiscard]] double step_after(std::size_t i) const {
    return std::abs(std::remainder(at_.theta[at_.after(i)] - at_.theta[i], core::kTwoPi));
  }
  [[nodiscard]] double off(std::size_t i, double beta) const {
    return std::abs(std::remainder(beta - at_.theta[i], core::kTwoPi));
  }

  /// Moves away from the nearest position as long as a wheel there could reach deeper. At the angle
  /// D from the direction, none reaches deeper than one at the least distance, whose reach shrinks
  /// with D. The greatest step is the margin for positions that are not in order of angle.
  template <class Next>
  void look(double beta, const Next& next) {
    std::size_t i = nearest_;
    for (std::size_t step = 1; step < at_.rho.size(); ++step) {
      i = next(i);
      const double inner = std::max(0.0, off(i, beta) - slack_);
      if (Positions::reach(at_.least_rho, at_.wheel, inner) > least_) return;
      const double reach = at_.reach(i, beta);
      if (reach >= least_) continue;
      least_ = reach;
      best_ = i;
    }
  }

  const Positions& at_;
  double slack_ = 0.0;
  std::size_t nearest_ = 0;
  std::size_t best_ = 0;
  double least_ = 0.0;
};

}  // namespace

GrindingPath refined(const GrindingPath& path, std::size_t times) {
  return {refined_series(path.x_mm, times), refined_series(path.y_mm, times)};
}

std::vector<double> envelope_radii_mm(const GrindingPath& path, double wheel_radius_mm,
                                      std::size_t samples, std::size_t oversampling) {
  const Positions at = positions_of(path, wheel_radius_mm, oversampling);
  Search search(at);
  std::vector<double> out(samples);
  for (std::size_t m = 0; m < samples; ++m) {
    out[m] = search.least(core::kTwoPi * static_cast<double>(m) / static_cast<double>(samples));
  }
  return out;
}

namespace {

/// First and second derivative of a periodic series over one turn, with respect to its parameter.
struct Derivatives {
  std::vector<double> first;
  std::vector<double> second;
};

Derivatives derivatives(std::span<const double> series) {
  auto once = spectrum(series);
  auto twice = once;
  for (std::size_t k = 0; k < once.size(); ++k) {
    const auto number = static_cast<double>(k);
    once[k] *= std::complex<double>(0.0, number);
    twice[k] *= -number * number;
  }
  if (series.size() % 2 == 0) once.back() = twice.back() = 0.0;
  return {series_of(once, series.size()), series_of(twice, series.size())};
}

/// The first derivative by central differences.
std::vector<double> differences(const std::vector<double>& series) {
  const std::size_t n = series.size();
  const double step = 2.0 * core::kTwoPi / static_cast<double>(n);
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = (series[(i + 1) % n] - series[(i + n - 1) % n]) / step;
  }
  return out;
}

/// Appends an angle, shifted by whole turns to be nearest to the last one.
void push_continuous(std::vector<double>& angles, double angle) {
  if (!angles.empty()) {
    angle = angles.back() + std::remainder(angle - angles.back(), core::kTwoPi);
  }
  angles.push_back(angle);
}

bool increases_all_round(const std::vector<double>& beta) {
  for (std::size_t i = 1; i < beta.size(); ++i) {
    if (beta[i] <= beta[i - 1]) return false;
  }
  return beta.back() < beta.front() + core::kTwoPi;
}

/// Resamples (beta, r) of one turn to the angles 2 pi m / M.
std::vector<double> resampled_radii(const ParallelCurve& curve, std::size_t samples) {
  std::vector<std::pair<double, double>> rows;
  for (std::size_t i = 0; i < curve.r_mm.size(); ++i) {
    const double beta = curve.beta_rad[i];
    const double turned = beta - core::kTwoPi * std::floor(beta / core::kTwoPi);
    rows.emplace_back(turned < core::kTwoPi ? turned : 0.0, curve.r_mm[i]);
  }
  // Beta increases, so angles wrapped at the end of the turn follow the greatest one.
  const auto first = std::ranges::min_element(rows);
  std::rotate(rows.begin(), first, rows.end());
  std::vector<double> beta;
  std::vector<double> r;
  for (const auto& [angle, radius] : rows) {
    beta.push_back(angle);
    r.push_back(radius);
  }
  return even_samples(std::move(beta), std::move(r), samples);
}

/// Positions farther apart than the wheel is wide leave angles that no position reaches.
core::Result<void> check_radii(const std::vector<double>& r_mm, const AxisErrors& errors,
                               double wheel_mm) {
  const auto none = std::ranges::find_if_not(r_mm, core::is_measurable);
  if (none == r_mm.end()) return {};
  return core::fail_with(
      core::Code::kOutOfRange,
      "the pin has no radius at {:.4g} deg: errors of X reach {:.4g} mm and those of C {:.4g} deg, "
      "too much for a wheel of {:.4g} mm radius; are they in mm and deg?",
      360.0 * static_cast<double>(none - r_mm.begin()) / static_cast<double>(r_mm.size()),
      largest_magnitude(errors.x_mm), largest_magnitude(errors.c_rad) / core::kDegree, wheel_mm);
}

}  // namespace

core::Result<GrindingPath> wheel_path(const CrankGeometry& geometry, const AxisErrors& errors) {
  TRY_DO(check_geometry(geometry));
  const std::size_t n = errors.c_rad.size();
  if (errors.x_mm.size() != n) {
    return core::fail_with(core::Code::kMeaning,
                           "{} errors of C and {} of X; both traces need the same samples", n,
                           errors.x_mm.size());
  }
  if (n < kLeastTurnSamples) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} samples over the turn; at least {} are needed", n,
                           kLeastTurnSamples);
  }
  GrindingPath path;
  for (std::size_t i = 0; i < n; ++i) {
    const double command = core::kTwoPi * static_cast<double>(i) / static_cast<double>(n);
    const double alpha = command + errors.c_rad[i];
    const double d = wheel_position_mm(geometry, command) + errors.x_mm[i];
    if (!std::isfinite(alpha) || !std::isfinite(d)) {
      return core::fail_with(
          core::Code::kNotFinite,
          "sample {} has the errors {} rad and {} mm; both must be finite numbers", i,
          errors.c_rad[i], errors.x_mm[i]);
    }
    if (d <= 0.0) {
      return core::fail_with(core::Code::kOutOfRange,
                             "sample {} puts the wheel centre at X = {:.4g} mm; it must stay above "
                             "0 mm: is the error of X, {:.4g} mm, in mm?",
                             i, d, errors.x_mm[i]);
    }
    path.x_mm.push_back(d * std::cos(alpha) - geometry.crank_radius_mm);
    path.y_mm.push_back(d * std::sin(alpha));
  }
  return path;
}

ParallelCurve parallel_curve(const GrindingPath& path, double wheel_radius_mm, ParallelForm form) {
  Derivatives x = derivatives(path.x_mm);
  Derivatives y = derivatives(path.y_mm);
  if (form == ParallelForm::kDifferences) {
    x.first = differences(path.x_mm);
    y.first = differences(path.y_mm);
  }
  ParallelCurve out;
  const std::size_t n = path.x_mm.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double s = std::hypot(x.first[i], y.first[i]);
    const double xc = path.x_mm[i] - wheel_radius_mm * y.first[i] / s;
    const double yc = path.y_mm[i] + wheel_radius_mm * x.first[i] / s;
    push_continuous(out.beta_rad, std::atan2(yc, xc));
    out.r_mm.push_back(std::hypot(xc, yc));
    const double kappa = (x.first[i] * y.second[i] - y.first[i] * x.second[i]) / (s * s * s);
    const double regularity = 1.0 - wheel_radius_mm * kappa;
    if (i > 0 && regularity >= out.regularity) continue;
    out.regularity = regularity;
    out.least_regular_rad = core::kTwoPi * static_cast<double>(i) / static_cast<double>(n);
  }
  out.undercut = !(out.regularity > 0.0) || !increases_all_round(out.beta_rad);
  return out;
}

core::Result<GroundContour> ground_contour(const CrankGeometry& geometry, const AxisErrors& errors,
                                           const GroundContourOptions& options) {
  if (options.samples < kLeastTurnSamples) {
    return core::fail_with(core::Code::kBadOption,
                           "a contour of {} points is asked for; at least {} are needed",
                           options.samples, kLeastTurnSamples);
  }
  TRY(const auto path, wheel_path(geometry, errors));
  const double wheel = geometry.wheel_radius_mm;
  const std::size_t times =
      options.refine ? (options.samples + path.x_mm.size() - 1) / path.x_mm.size() : 1;
  const ParallelCurve curve =
      parallel_curve(times > 1 ? refined(path, times) : path, wheel, options.form);
  GroundContour out;
  out.regularity = curve.regularity;
  out.least_regular_rad = curve.least_regular_rad;
  out.undercut = curve.undercut;
  out.r_mm = out.undercut ? envelope_radii_mm(path, wheel, options.samples)
                          : resampled_radii(curve, options.samples);
  TRY_DO(check_radii(out.r_mm, errors, wheel));
  return out;
}

}  // namespace rondure::fit
