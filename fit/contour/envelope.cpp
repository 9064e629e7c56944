#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "fit/contour/ground_contour.h"
#include "fit/profiles/internal/dft.h"

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

}  // namespace rondure::fit
