#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/points.h"

namespace rondure::fit {

/// Points about a centre, in the order of their angles.
struct AngularOrder {
  std::vector<std::size_t> rows;  ///< In the order of angles, from the far side of the largest gap.
  std::vector<double> angles_rad;  ///< Angles of `rows`, ascending, over less than one turn.
  double largest_gap_rad = 0.0;

  /// The arc of the circle that holds points [rad].
  [[nodiscard]] double coverage_rad() const;
  /// Whether the last point is a neighbour of the first: no gap above 90 deg.
  [[nodiscard]] bool closed() const;
  /// Whether no gap is wider than two even steps: lobes of orders 2 and 3 then hardly move R.
  [[nodiscard]] bool even() const;
};
/// Sorts points by their angle about a centre.
[[nodiscard]] AngularOrder angular_order(PlanePoints points_mm, const Eigen::Vector2d& center_mm);

/// Scatter of a least-squares circle relative to the scatter of a point, from the angles.
struct CircleFactors {
  double center = 0.0;  ///< sigma_S: root of the summed variances of both coordinates.
  double radius = 0.0;  ///< a_R
};
/// Computes the factors from the normal equations with rows (cos, sin, 1); both are infinite if
/// these are singular. Neighbours at the same angle count once: a row of a file given twice.
/// @param angles_rad  In angular order.
[[nodiscard]] CircleFactors circle_factors(std::span<const double> angles_rad);

/// Number of neighbouring residuals that count as one: tau = max(1, 1 + 2 (rho_1 + rho_2 + ...)),
/// with the autocorrelation in angular order, summed up to the first value that is not positive.
/// White noise gives 1.0 to 1.1.
/// @param residuals  In angular order, about their mean.
/// @param closed  Whether the last residual is a neighbour of the first.
[[nodiscard]] double correlation_time(std::span<const double> residuals, bool closed);

}  // namespace rondure::fit
