#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/zone/deviation_range.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// A circle (D = 2) or sphere (D = 3) that touches the points from one side.
template <int D>
struct OneSidedCenter {
  Eigen::Matrix<double, D, 1> center_mm = Eigen::Matrix<double, D, 1>::Zero();
  double radius_mm = 0.0;
  double deviation_mm = 0.0;      ///< Radial peak to valley about the centre [mm].
  std::vector<Contact> contacts;  ///< Points that determine it; multipliers sum to 1.
  Certificate certificate;
  /// Least and greatest deviation, where several inscribed circles are equally large to kSameRadius
  /// and the deviations about them differ.
  std::optional<DeviationRange> range;
};
using OneSidedCircle = OneSidedCenter<2>;
using OneSidedSphere = OneSidedCenter<3>;

/// Finds the minimum circumscribed circle (MCCI) or sphere: the smallest that holds all points. The
/// problem is convex and has a single optimum, so the contacts alone make the certificate global.
///
/// @param points_mm  At least 3 (sphere: 4) points, not on one line (in one plane) [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear (sphere: kRank). Same input, same
///         bits. Cost: as ZoneDescent.
/// Sources: ISO 12181-1; methods, cylindricity section 11.4.
[[nodiscard]] core::Result<OneSidedCircle> min_circumscribed_circle(PlanePoints points_mm);
[[nodiscard]] core::Result<OneSidedSphere> min_circumscribed_sphere(SpacePoints points_mm);

/// Finds the maximum inscribed circle (MICI) or sphere: the largest without a point inside, with
/// its centre inside the hull of the points.
///
/// The descent starts at the least-squares circle. Then all centres inside the hull are searched
/// for a larger circle (search_centers()), which becomes the new start. For a sphere the result is
/// the one next to the least-squares sphere, with a local certificate.
///
/// @param points_mm  As min_circumscribed_circle() [mm].
/// @return as min_circumscribed_circle(); also kReferenceAbsent if the points leave a gap through
///         which the circle or sphere grows without bound.
/// Sources: ISO 12181-1; methods, cylindricity section 11.4, certificates section 2.
[[nodiscard]] core::Result<OneSidedCircle> max_inscribed_circle(
    PlanePoints points_mm, const CenterProofOptions& options = {});
[[nodiscard]] core::Result<OneSidedSphere> max_inscribed_sphere(SpacePoints points_mm);

/// A cylinder that touches the points from one side.
struct OneSidedCylinder {
  /// A cylinder that is better but not the reference.
  struct Other {
    double radius_mm = 0.0;
    double lean_rad = 0.0;  ///< Angle between its axis and that of the reference.
    double apart_mm = 0.0;  ///< Distance of its axis from the middle of that of the reference.
  };
  Axis axis;
  double radius_mm = 0.0;
  double deviation_mm = 0.0;      ///< Radial peak to valley about the axis [mm].
  std::vector<Contact> contacts;  ///< Points that determine the cylinder; multipliers sum to 1.
  Certificate certificate;
  std::optional<Other> other;  ///< If the search found one: across a disc, or outside the reach.
};

/// Finds the minimum circumscribed cylinder (MCCY) or the maximum inscribed cylinder (MICY) about
/// the axis of the part, as the standards mean it: the smallest (largest) cylinder of all axes
/// within 10 deg of the least-squares axis. A cylinder across a short disc may be smaller; it is
/// not the reference and is reported in `other`.
///
/// The descent starts at the least-squares axis. Then the scopes of the options are searched for a
/// better axis (search_axes()), which becomes the new start. For an inscribed cylinder, whatever
/// the options name, the scope is the axes within half a radius of the least-squares axis over the
/// length of the points; farther out it could grow without bound.
///
/// @param points_mm       n >= 5 points that surround the axis in at least two sections [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return as ls_cylinder(); kReferenceAbsent if there is none within one radius (circumscribed:
///         two radii) and 10 deg of the least-squares axis. Same input, same bits. Cost: as
///         ZoneDescent, and some ms of proof.
/// Sources: ISO 12180-1; methods, cylindricity section 11.4, certificates section 3.
[[nodiscard]] core::Result<OneSidedCylinder> min_circumscribed_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const CylinderProofOptions& options = {});
[[nodiscard]] core::Result<OneSidedCylinder> max_inscribed_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const CylinderProofOptions& options = {});

}  // namespace rondure::fit
