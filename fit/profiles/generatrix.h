#pragma once

#include <span>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/profiles/form_parameters.h"

namespace rondure::fit {

/// Straightness of one generatrix in the plane through the axis (ISO 12780-1).
struct GeneratrixStraightness {
  FormParameters ls;      ///< STRt, STRp, STRv, STRq about the least-squares line.
  double zone_mm = 0.0;   ///< STRt about the minimum-zone line: least distance of two parallels.
  double ls_slope = 0.0;  ///< Radius per length of the least-squares line.
};

/// Computes the straightness of a generatrix. Deviations are measured perpendicular to the lines.
/// The zone is exact: the narrowest strip over all directions, which is the least width of the
/// convex hull and is attained at an edge. O(n log n).
/// @param z_mm  Positions along the axis; n >= 3, at least two different [mm].
/// @param r_mm  Distances from the axis there [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kRank (all at one position).
/// Source of the zone: M. E. Houle, G. T. Toussaint, IEEE Trans. PAMI 10 (1988) 761-765.
[[nodiscard]] core::Result<GeneratrixStraightness> generatrix_straightness(
    std::span<const double> z_mm, std::span<const double> r_mm);

/// Taper of a cylinder about its axis: the radii are fitted by r = r0 + slope z (least squares).
struct Taper {
  double slope = 0.0;        ///< Radius per length along the axis direction; > 0: widening.
  double diameter_mm = 0.0;  ///< Change of the diameter over the length of the data, signed [mm].
  double cone_angle_rad = 0.0;  ///< Angle between opposite generatrices, signed: 2 atan(slope).
};

/// Computes the taper of points about an axis.
/// @return kNoPoints, kNotFinite (row), kRank (all points in one section).
[[nodiscard]] core::Result<Taper> taper(SpacePoints points_mm, const Axis& axis);

}  // namespace rondure::fit
