#pragma once

#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"

namespace rondure::fit {

/// Fits the least-squares sphere: minimises the sum of squared radial (orthogonal) distances by
/// damped Gauss-Newton from the algebraic sphere, which has a closed form and is exact for points
/// of one sphere.
///
/// @param points_mm  n >= 4, not all in one plane, any order and place [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kRank (one plane: the height of the centre
///         is undetermined), kNotConverged. O(n) per step.
/// Source: methods, cylindricity section 2.1.
[[nodiscard]] core::Result<LsSphere> ls_sphere(SpacePoints points_mm);

}  // namespace rondure::fit
