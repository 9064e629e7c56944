#include "core/open_spline.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace rondure::core {

OpenSpline::OpenSpline(std::vector<double> x, std::vector<double> values)
    : x_(std::move(x)), values_(std::move(values)) {
  const std::size_t n = x_.size();
  assert(n >= 4 && values_.size() == n);
  const auto h = [&](std::size_t i) { return x_[i + 1] - x_[i]; };
  const auto rise = [&](std::size_t i) { return (values_[i + 1] - values_[i]) / h(i); };
  // Rows 1 .. n-2 of the tridiagonal system; the end conditions eliminate both end values.
  std::vector<double> below(n), diagonal(n), above(n);
  second_.resize(n);
  for (std::size_t i = 1; i + 1 < n; ++i) {
    below[i] = h(i - 1);
    diagonal[i] = 2.0 * (h(i - 1) + h(i));
    above[i] = h(i);
    second_[i] = 6.0 * (rise(i) - rise(i - 1));
  }
  const double first = h(0) / h(1);
  diagonal[1] += h(0) * (1.0 + first);
  above[1] -= h(0) * first;
  const double last = h(n - 2) / h(n - 3);
  diagonal[n - 2] += h(n - 2) * (1.0 + last);
  below[n - 2] -= h(n - 2) * last;
  for (std::size_t i = 2; i + 1 < n; ++i) {
    const double factor = below[i] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    second_[i] -= factor * second_[i - 1];
  }
  second_[n - 2] /= diagonal[n - 2];
  for (std::size_t i = n - 2; i-- > 1;) {
    second_[i] = (second_[i] - above[i] * second_[i + 1]) / diagonal[i];
  }
  second_[0] = second_[1] * (1.0 + first) - second_[2] * first;
  second_[n - 1] = second_[n - 2] * (1.0 + last) - second_[n - 3] * last;
}

OpenSpline::Place OpenSpline::operator()(double x) const {
  const auto next = std::upper_bound(x_.begin() + 1, x_.end() - 1, x);
  const auto i = static_cast<std::size_t>(next - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i];
  const double b = (x - x_[i]) / h;
  const double a = 1.0 - b;
  Place out;
  out.value = a * values_[i] + b * values_[i + 1] +
              ((a * a * a - a) * second_[i] + (b * b * b - b) * second_[i + 1]) * h * h / 6.0;
  out.slope = (values_[i + 1] - values_[i]) / h +
              ((3.0 * b * b - 1.0) * second_[i + 1] - (3.0 * a * a - 1.0) * second_[i]) * h / 6.0;
  out.second = a * second_[i] + b * second_[i + 1];
  return out;
}

}  // namespace rondure::core
