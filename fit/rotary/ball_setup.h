#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// Condition of the six errors as determined by balls at given positions, all measured equally
/// well: origin at the centroid, unit the rms distance from it; >= 1.
/// @param p_mm  n >= 1 balls relative to the origin of the axis [mm], finite.
/// @return Infinity if the balls do not determine all six errors. O(n).
[[nodiscard]] double setup_condition(SpacePoints p_mm);

/// A condition above kConditionWarning causes a warning; above kConditionLimit the balls are nearly
/// on a line.
inline constexpr double kConditionWarning = 10.0;
inline constexpr double kConditionLimit = 100.0;

/// Refuses balls that do not determine the six errors, and names the further ball that is needed.
/// @param names  One per ball.
/// @return kTooFewPoints (fewer than 3), kCollinear (second singular value of the centred balls
///         below 1e-3 of the first, or condition above kConditionLimit): `what` states the distance
///         of a further ball from the named line for a condition of at most kConditionWarning.
[[nodiscard]] core::Result<void> check_setup(SpacePoints p_mm, std::span<const std::string> names);

}  // namespace rondure::fit
