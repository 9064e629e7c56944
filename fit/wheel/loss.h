#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/points.h"

namespace rondure::fit {

/// Amplitudes of the distances of points from a centre, of the orders 1, 2, ... [mm]; order 1 is
/// the eccentricity of the points about that centre.
///
/// By least squares, up to the highest order, at most 15, for which the places of the points hold
/// every amplitude within twice the uncertainty that even places would give: a gap ends them.
/// Noise of the points makes them larger on average. Its power is taken off each order: that of the
/// declared noise, and no more than the median over the orders shows, among which lobes are few. A
/// noise declared too large therefore hides no lobe.
/// @param point_mm  Declared standard uncertainty of a point along the radius; 0: not declared.
/// @return Empty where not even order 1 is held (an arc): eccentricity is never extrapolated.
[[nodiscard]] std::vector<double> found_amplitudes(PlanePoints points_mm,
                                                   const Eigen::Vector2d& center_mm,
                                                   double point_mm = 0.0);

/// Most that a peak to valley can lose in a gap between points:
/// sum over k of 2 A_k (1 - cos(min(k gap / 2, pi))) [mm].
/// @param amplitudes_mm  Of the orders 1, 2, ...
/// @param first_order  Lower orders are left out: 2 for roundness.
[[nodiscard]] double loss_in_gap_mm(double gap_rad, std::span<const double> amplitudes_mm,
                                    int first_order = 1);

/// What lobes of orders 2 and 3 add to the standard uncertainty of the radius of an arc, which does
/// not tell them from it [mm]: a normal error as wide, at 95 %, as the effect of lobes of random
/// phase. Their size follows from what the circle leaves of the points. It is at least s, the noise
/// of a point or the form that they do not explain: its square is (1 + p) s^2, p with the prior
/// density 1/(1 + p)^2.
/// @param residuals_mm  Distances less those of a circle, one for each angle; n >= 5.
/// @param point_mm  Standard uncertainty of a point along the radius.
[[nodiscard]] double lobes_in_radius_mm(std::span<const double> angles_rad,
                                        std::span<const double> residuals_mm, double point_mm);

}  // namespace rondure::fit
