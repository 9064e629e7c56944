#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/plane.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// Coaxiality deviation (ISO 1101): diameter of the smallest cylinder about the datum axis that
/// holds the toleranced axis = 2 max |c_i - datum|.
/// @param median_mm  Points of the extracted median line: the circle centres of the sections, or
///                   the two ends of a fitted axis.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<double> coaxiality_mm(SpacePoints median_mm, const Axis& datum);

/// Parallelism of an axis to an axis, perpendicularity of an axis to a plane (ISO 1101, zone with
/// diameter sign): diameter of the least circle round the points of the median line, seen along the
/// datum. The zone is free to move, so that it is not above the coaxiality.
/// @param median_mm  Centres of at least two sections.
/// @param datum      Direction of the datum axis, or normal of the datum plane; of length 1.
/// @return kNoPoints, kNotFinite (row), kRank (one centre).
[[nodiscard]] core::Result<double> orientation_of_axis_mm(SpacePoints median_mm,
                                                          const Eigen::Vector3d& datum);

/// Parallelism of a plane or of an axis to a plane, perpendicularity of a plane to an axis (ISO
/// 1101): distance of the two planes with the given normal that enclose the points.
/// @param points_mm  Points of the plane, or of the median line of the axis.
/// @param normal     Normal of the zone; of length 1.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<double> orientation_of_plane_mm(SpacePoints points_mm,
                                                           const Eigen::Vector3d& normal);

/// Two parallel planes at a given angle to a datum that hold points between them.
struct InclinedZone {
  Plane outer;            ///< The plane on the outer side of the material.
  double width_mm = 0.0;  ///< Angularity of a plane (ISO 1101) [mm].
};

/// Angularity of a plane to a datum plane or axis: the least distance of two planes whose normal
/// makes the angle with the datum and that enclose the points. The zone is free to turn about the
/// datum; of the positions that are minima, the result is the one next to the least-squares plane.
/// @param datum      Normal of the datum plane or direction of the datum axis; of length 1.
/// @param angle_rad  Between the datum and the normal of the zone, above 0 and up to 90 deg: the
///                   nominal angle of plane to plane, 90 deg minus that of plane to axis.
/// @param outward    As ls_plane().
/// @return as ls_plane(); kBadOption for another angle; kNotConverged. O(n) per step.
/// Source: methods, drawing section 5; ISO 1101.
[[nodiscard]] core::Result<InclinedZone> inclined_zone(
    SpacePoints points_mm, const Eigen::Vector3d& datum, double angle_rad,
    const std::optional<Eigen::Vector3d>& outward = std::nullopt);

/// Angularity of an axis to a datum (ISO 1101, zone with diameter sign): diameter of the least
/// cylinder at the given angle to the datum that holds the median line, next to its least-squares
/// line.
/// @param median_mm  Centres of at least two sections.
/// @param datum      As inclined_zone().
/// @param angle_rad  Between the datum and the axis of the zone, above 0 and up to 90 deg: the
///                   nominal angle of axis to axis, 90 deg minus that of axis to plane.
/// @return as ls_line(); kRank (one centre), kBadOption, kNotConverged.
[[nodiscard]] core::Result<double> angularity_of_axis_mm(SpacePoints median_mm,
                                                         const Eigen::Vector3d& datum,
                                                         double angle_rad);

}  // namespace rondure::fit
