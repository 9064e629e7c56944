#pragma once

#include <cstddef>
#include <vector>

namespace rondure::fit {

/// Cubic spline of period 2 pi through given points, with a continuous second derivative all round.
/// Error at most (5/384) h^4 max|r''''| for the largest step h (C. A. Hall, W. W. Meyer, J. Approx.
/// Theory 16, 1976).
class PeriodicSpline {
 public:
  /// @pre `theta_rad` holds n >= 3 strictly ascending angles in [0, 2 pi), `values` as many.
  PeriodicSpline(std::vector<double> theta_rad, std::vector<double> values);

  /// Value at an angle in [0, 2 pi].
  [[nodiscard]] double operator()(double theta_rad) const;

 private:
  std::vector<double> theta_;  ///< The first point is repeated at the end, one turn on.
  std::vector<double> values_;
  std::vector<double> second_;  ///< Second derivatives at the points.
};

/// Samples a closed curve at the angles 2 pi n / count by the spline through its points. Where it
/// has more than `count` points, the spline is evaluated on finer_count() samples and decimated().
/// @param kept  See decimated().
/// @pre As the constructor of PeriodicSpline.
[[nodiscard]] std::vector<double> even_samples(std::vector<double> theta_rad,
                                               std::vector<double> values, std::size_t count,
                                               double kept = 0.0);

/// Returns the number of samples, a multiple of `count`, that keeps all the detail of a spline
/// through this many points.
[[nodiscard]] std::size_t finer_count(std::size_t points, std::size_t count);

/// Transmission of an undulation by the spline through equally spaced points: near 1 for many
/// points per undulation, 0.49 at two.
[[nodiscard]] double spline_transmission(double undulations_per_point);

}  // namespace rondure::fit
