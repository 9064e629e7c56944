#pragma once

#include <vector>

namespace rondure::core {

/// Cubic spline through points of an open curve; its third derivative runs on across the second and
/// the last but one point (not-a-knot), so that any cubic is reproduced to round-off and the ends
/// are not bent straight as in a natural spline. Error of the second derivative O(h^2).
class OpenSpline {
 public:
  struct Place {
    double value = 0.0;
    double slope = 0.0;
    double second = 0.0;
  };

  /// @param x  n >= 4, strictly ascending.
  OpenSpline(std::vector<double> x, std::vector<double> values);

  /// Value and derivatives; beyond the ends the outermost cubics run on.
  [[nodiscard]] Place operator()(double x) const;
  [[nodiscard]] const std::vector<double>& x() const { return x_; }

 private:
  std::vector<double> x_;
  std::vector<double> values_;
  std::vector<double> second_;  ///< Second derivatives at the points.
};

}  // namespace rondure::core
