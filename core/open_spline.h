#pragma once

#include <vector>

namespace rondure::core {

/// Cubic spline through the points of an open curve. Its third derivative is continuous at the
/// second and at the last but one point (not-a-knot), so that it reproduces any cubic to round-off,
/// without straightening the ends as a natural spline does. The error of the second derivative is
/// O(h^2).
class OpenSpline {
 public:
  struct Place {
    double value = 0.0;
    double slope = 0.0;
    double second = 0.0;
  };

  /// @pre `x` holds n >= 4 strictly ascending numbers, `values` as many.
  OpenSpline(std::vector<double> x, std::vector<double> values);

  /// Value and derivatives at `x`; beyond the ends the outermost cubics are extrapolated.
  [[nodiscard]] Place operator()(double x) const;
  [[nodiscard]] const std::vector<double>& x() const { return x_; }

 private:
  std::vector<double> x_;
  std::vector<double> values_;
  std::vector<double> second_;  ///< Second derivatives at the points.
};

}  // namespace rondure::core
