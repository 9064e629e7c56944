#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/axis_scope.h"
#include "fit/proof/certificate.h"
#include "fit/zone/contacts.h"

namespace rondure::fit {

/// A cylinder that touches the points from one side.
struct OneSidedCylinder {
  /// A cylinder that is better but not the reference.
  struct Other {
    double radius_mm = 0.0;
    double lean_rad = 0.0;  ///< Of its axis to that of the reference.
    double apart_mm = 0.0;  ///< Of its axis from the middle of that of the reference.
  };
  Axis axis;
  double radius_mm = 0.0;
  double deviation_mm = 0.0;      ///< Radial peak to valley about the axis [mm].
  std::vector<Contact> contacts;  ///< Points on the cylinder that carry it; multipliers sum to 1.
  Certificate certificate;
  std::optional<Other> other;  ///< Met by the search: across a disc, or outside the reach.
};

/// Minimum circumscribed cylinder (MCCY), maximum inscribed cylinder (MICY) about the axis of the
/// part, as the standards mean it: of all axes within 10 deg of the least-squares axis the one with
/// the smallest (largest) cylinder. A cylinder across a short disc may be smaller; it is not the
/// reference, and `other` says so.
///
/// The descent starts at the least-squares axis. Then the scopes of the options are searched for a
/// better axis (global_search.h), which becomes the new start. The scope of an inscribed cylinder
/// is that of axes within half a radius of the least-squares one over the length of the points,
/// whatever the options name: farther out it could grow without bound.
///
/// @param points_mm       n >= 5 points that surround the axis in at least two sections [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return as ls_cylinder(); kReferenceAbsent where there is none within a radius (circumscribed:
///         two radii) and 10 deg of the least-squares axis. Same input, same bits.
/// Cost: as ZoneDescent, and some ms of proof.
/// Sources: ISO 12180-1; methods, cylindricity section 11.4, certificates section 3.
[[nodiscard]] core::Result<OneSidedCylinder> min_circumscribed_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const CylinderProofOptions& options = {});
[[nodiscard]] core::Result<OneSidedCylinder> max_inscribed_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const CylinderProofOptions& options = {});

}  // namespace rondure::fit
