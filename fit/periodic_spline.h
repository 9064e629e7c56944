#pragma once

#include <vector>

namespace rondure::fit {

/// Cubic spline of period 2 pi through points, with continuous second derivative all round.
/// Error at most (5/384) h^4 max|r''''| for the largest step h (C. A. Hall, W. W. Meyer, J. Approx.
/// Theory 16, 1976).
class PeriodicSpline {
 public:
  /// @param theta_rad  n >= 3 angles, strictly ascending, in [0, 2 pi).
  PeriodicSpline(std::vector<double> theta_rad, std::vector<double> values);

  /// Value at an angle in [0, 2 pi].
  [[nodiscard]] double operator()(double theta_rad) const;

 private:
  std::vector<double> theta_;  ///< The first point stands again at the end, one turn on.
  std::vector<double> values_;
  std::vector<double> second_;  ///< Second derivatives at the points.
};

}  // namespace rondure::fit
