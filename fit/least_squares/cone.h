#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// A cone of revolution.
struct Cone {
  Axis axis;  ///< In the convention of Axis; its point is not the apex.
  /// Angle between opposite generatrices: > 0 if the cone opens along the axis, < 0 if it closes.
  double full_angle_rad = 0.0;
  /// Distance of the surface from the point of the axis, normal to the surface. For tip centres the
  /// surface itself is at offset_mm minus (shaft) or plus (bore) the tip radius [mm].
  double offset_mm = 0.0;

  /// Diameter square to the axis at a height along it, from the point of the axis [mm].
  [[nodiscard]] double diameter_mm(double height_mm) const;
  /// Distance of a point from the surface, normal to it; > 0 on the side away from the axis [mm].
  [[nodiscard]] double deviation_mm(const Eigen::Vector3d& point_mm) const;
};

/// A least-squares cone.
struct LsCone {
  Cone cone;
  double deviation_mm = 0.0;  ///< Peak to valley normal to the surface [mm].
  double rms_mm = 0.0;
};

/// Fits the least-squares cone: minimises the sum of squared distances normal to the surface over
/// the axis, the angle and the offset (six unknowns), by Levenberg-Marquardt in a frame that
/// follows the axis, from the algebraic cone that is linear in centre, tilt and taper.
///
/// @param points_mm       n >= 6 in at least two sections, any order and place [mm].
/// @param near_direction  Start direction, of either sign; without it the half sphere is searched.
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kRank (one section, or points that leave the
///         axis undetermined), kOutOfRange (half angle below 0.05 deg: a cylinder; above 89.95 deg:
///         a plane), kNotConverged. O(n) per step.
/// Source: methods, drawing section 9.2.
[[nodiscard]] core::Result<LsCone> ls_cone(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

}  // namespace rondure::fit
