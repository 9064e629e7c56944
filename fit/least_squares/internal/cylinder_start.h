#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// Finds directions from which to start the search for a cylinder when none is known. Scans the
/// half sphere with the algebraic circle of the projected points and returns the directions with
/// the least residuals, at least 12 deg apart, best first.
///
/// @param points  Relative to their mean; a strided sample is used. Cost: some 250 directions.
[[nodiscard]] std::vector<Eigen::Vector3d> start_directions(
    std::span<const Eigen::Vector3d> points);

}  // namespace rondure::fit
