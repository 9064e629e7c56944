#include "fit/profiles/periodic_spline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/units.h"
#include "fit/profiles/internal/dft.h"

namespace rondure::fit {
namespace {

/// Solves the diagonally dominant tridiagonal system (below, diagonal, above) by elimination.
std::vector<double> solve_tridiagonal(const std::vector<double>& below,
                                      std::vector<double> diagonal,
                                      const std::vector<double>& above, std::vector<double> right) {
  const std::size_t n = right.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right[i] -= factor * right[i - 1];
  }
  right[n - 1] /= diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;)
    right[i] = (right[i] - above[i] * right[i + 1]) / diagonal[i];
  return right;
}

}  // namespace

PeriodicSpline::PeriodicSpline(std::vector<double> theta_rad, std::vector<double> values)
    : theta_(std::move(theta_rad)), values_(std::move(values)) {
  const std::size_t n = theta_.size();
  assert(n >= 3 && values_.size() == n);
  theta_.push_back(theta_.front() + core::kTwoPi);
  values_.push_back(values_.front());

  std::vector<double> below(n);
  std::vector<double> diagonal(n);
  std::vector<double> above(n);
  std::vector<double> right(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t last = i > 0 ? i - 1 : n - 1;
    const double h0 = theta_[last + 1] - theta_[last];
    const double h1 = theta_[i + 1] - theta_[i];
    below[i] = h0;
    diagonal[i] = 2.0 * (h0 + h1);
    above[i] = h1;
    right[i] =
        6.0 * ((values_[i + 1] - values_[i]) / h1 - (values_[last + 1] - values_[last]) / h0);
  }
  // The two corners of the cyclic matrix are a rank-one change (Sherman, Morrison).
  const double gamma = -diagonal[0];
  const double corner = below[0];
  diagonal[0] -= gamma;
  diagonal[n - 1] -= corner * corner / gamma;
  std::vector<double> u(n, 0.0);
  u[0] = gamma;
  u[n - 1] = corner;
  const auto x = solve_tridiagonal(below, diagonal, above, right);
  const auto z = solve_tridiagonal(below, diagonal, above, u);
  const double share =
      (x[0] + corner * x[n - 1] / gamma) / (1.0 + z[0] + corner * z[n - 1] / gamma);
  second_.resize(n + 1);
  for (std::size_t i = 0; i < n; ++i) second_[i] = x[i] - share * z[i];
  second_[n] = second_[0];
}

double PeriodicSpline::operator()(double theta_rad) const {
  if (theta_rad < theta_.front()) theta_rad += core::kTwoPi;
  const auto above = std::upper_bound(theta_.begin() + 1, theta_.end() - 1, theta_rad);
  const auto i = static_cast<std::size_t>(above - theta_.begin()) - 1;
  const double h = theta_[i + 1] - theta_[i];
  const double b = (theta_rad - theta_[i]) / h;
  const double a = 1.0 - b;
  return a * values_[i] + b * values_[i + 1] +
         ((a * a * a - a) * second_[i] + (b * b * b - b) * second_[i + 1]) * h * h / 6.0;
}

std::size_t finer_count(std::size_t points, std::size_t count) {
  return points > count ? count * ((2 * points + count - 1) / count) : count;
}

std::vector<double> even_samples(std::vector<double> theta_rad, std::vector<double> values,
                                 std::size_t count, double kept) {
  std::vector<double> fine(finer_count(theta_rad.size(), count));
  const PeriodicSpline spline(std::move(theta_rad), std::move(values));
  for (std::size_t n = 0; n < fine.size(); ++n) {
    fine[n] = spline(core::kTwoPi * static_cast<double>(n) / static_cast<double>(fine.size()));
  }
  return decimated(fine, count, kept);
}

double spline_transmission(double undulations_per_point) {
  // M. Unser, IEEE Signal Processing Magazine 16 (1999) 22: the cardinal cubic spline.
  const double angle = std::numbers::pi * undulations_per_point;
  if (angle == 0.0) return 1.0;
  return 3.0 * std::pow(std::sin(angle) / angle, 4) / (2.0 + std::cos(2.0 * angle));
}

}  // namespace rondure::fit
