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
/// Noise of the points makes them larger on average; they count as found, because a lobe that does
/// not stand out of the noise may be there all the same.
/// @return Empty where not even order 1 is held (an arc): eccentricity is never extrapolated.
[[nodiscard]] std::vector<double> found_amplitudes(PlanePoints points_mm,
                                                   const Eigen::Vector2d& center_mm);

/// Most that a peak to valley can lose in a gap between points:
/// sum over k of 2 A_k (1 - cos(min(k gap / 2, pi))) [mm].
/// @param amplitudes_mm  Of the orders 1, 2, ...
/// @param first_order  Lower orders are left out: 2 for roundness.
[[nodiscard]] double loss_in_gap_mm(double gap_rad, std::span<const double> amplitudes_mm,
                                    int first_order = 1);

}  // namespace rondure::fit
