#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/points.h"

namespace rondure::fit {

/// Directions from which to start when none is known: scores directions spread over the half sphere
/// and the principal axes on a sample of the points, and returns those with the least residuals, at
/// least 12 deg apart, best first. Cost: some 250 directions.
/// @param points  Relative to their mean.
/// @param rms     Residual of a sample along a direction; nothing if it has none.
[[nodiscard]] std::vector<Eigen::Vector3d> start_directions(
    SpacePoints points,
    const std::function<std::optional<double>(SpacePoints, const Eigen::Vector3d&)>& rms);

}  // namespace rondure::fit
