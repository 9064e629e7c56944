#pragma once

#include <cstddef>
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

/// A closed curve at the angles 2 pi n / count, by the spline through its points; where these are
/// more than `count`, by the spline on finer samples and decimated().
/// @param kept  As decimated().
[[nodiscard]] std::vector<double> even_samples(std::vector<double> theta_rad,
                                               std::vector<double> values, std::size_t count,
                                               double kept = 0.0);

/// Whole multiple of `count` samples on which a spline through so many points loses nothing.
[[nodiscard]] std::size_t finer_count(std::size_t points, std::size_t count);

/// What the spline through even points leaves of an undulation: near 1 for many points each, 0.49
/// at two.
[[nodiscard]] double spline_transmission(double undulations_per_point);

}  // namespace rondure::fit
