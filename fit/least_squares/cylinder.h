#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// A least-squares cylinder.
struct LsCylinder {
  Axis axis;
  double radius_mm = 0.0;
  double deviation_mm = 0.0;  ///< Radial peak to valley about the axis [mm].
  double rms_mm = 0.0;
};

/// Fits the least-squares cylinder (LSCY): minimises the sum of squared radial distances over the
/// axis (four unknowns) and the radius, by Levenberg-Marquardt in a frame that follows the axis.
///
/// @param points_mm       n >= 5, any order, any place and orientation [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear, kRank (one layer: the tilt is
///         undetermined), kNotConverged. O(n) per step.
/// Source: ISO 12180-1; methods, cylindricity section 11.1.
[[nodiscard]] core::Result<LsCylinder> ls_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

/// Whether no other cylinder passes near the same few points: a least-squares one whose axis leans
/// more than 10 deg from that of `found` and which lies within 0.5 % of its radius of every point.
/// Eight corners of a box have three. Sought from 62 directions; sets of more than 64
/// points are not searched.
/// @return kSeveralOptima with one of the others.
[[nodiscard]] core::Result<void> check_only_cylinder(SpacePoints points_mm,
                                                     const LsCylinder& found);

}  // namespace rondure::fit
