#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/plane.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// A least-squares plane.
struct LsPlane {
  Plane plane;                ///< Through the mean of the points.
  double deviation_mm = 0.0;  ///< Peak to valley: the flatness FLTt about this plane [mm].
  double rms_mm = 0.0;        ///< FLTq [mm].
};

/// Fits the least-squares plane (LSPL): minimises the sum of squared orthogonal distances. The
/// normal is the least principal axis, followed by one step that keeps the digits of small
/// distances on a large plane.
///
/// @param points_mm  n >= 3, not along one line [mm].
/// @param outward    A direction out of the material, not parallel to the plane; without it the
///                   convention of Plane.
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear (standard deviation within the
///         plane, across the points, below 1 % of that along them), kRank (no direction has the
///         least extent). Two passes.
/// Source: K. Pearson, Philosophical Magazine 2 (1901) 559-572; methods, drawing section 9.1.
[[nodiscard]] core::Result<LsPlane> ls_plane(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& outward = std::nullopt);

}  // namespace rondure::fit
