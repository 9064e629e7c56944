#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// Directions from which the search for a cylinder should start when none is known: the half sphere
/// is scanned with the algebraic circle of the projected points, and the directions with the least
/// residual, apart from each other, are given, best first.
///
/// @param points  Relative to their mean; a strided sample is looked at. Cost: some 250 directions.
[[nodiscard]] std::vector<Eigen::Vector3d> start_directions(
    std::span<const Eigen::Vector3d> points);

}  // namespace rondure::fit
