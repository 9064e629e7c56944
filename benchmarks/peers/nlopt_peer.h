#pragma once

#include <functional>
#include <span>

#include <Eigen/Core>

#include "fit/geometry/axis.h"

namespace rondure::benchmarks {

/// A zone found by a peer.
struct PeerZone {
  fit::Axis axis;
  double width_mm = 0.0;
  int evaluations = 0;  ///< Of the objective, or of all constraints together.
};

/// Minimum-zone cylinder as a smooth problem with constraints: least h with |r_i - R| <= h for
/// every point, six unknowns, exact derivatives, SLSQP from the mean of the points.
[[nodiscard]] PeerZone nlopt_slsqp_zone(std::span<const Eigen::Vector3d> points_mm,
                                        const Eigen::Vector3d& start_direction);

/// Minimum-zone cylinder by Nelder and Mead over two shifts and two slopes about `start`, stopped
/// when the width settles to 1e-9 of itself.
///
/// @param width_mm  Width of the zone about an axis: the caller's fastest.
/// @param half_length_mm  Makes slopes as large as shifts.
[[nodiscard]] PeerZone nlopt_nelder_mead_zone(
    const std::function<double(const fit::Axis&)>& width_mm, const fit::Axis& start,
    double half_length_mm);

}  // namespace rondure::benchmarks
