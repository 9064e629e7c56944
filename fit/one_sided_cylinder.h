#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/axis.h"
#include "fit/certificate.h"
#include "fit/contacts.h"

namespace rondure::fit {

/// A cylinder that touches the points from one side.
struct OneSidedCylinder {
  Axis axis;
  double radius_mm = 0.0;
  double deviation_mm = 0.0;      ///< Radial peak to valley about the axis [mm].
  std::vector<Contact> contacts;  ///< Points on the cylinder that carry it; multipliers sum to 1.
  Certificate certificate;  ///< Local at most: the reference is the one next to the part axis.
};

/// Minimum circumscribed cylinder (MCCY), maximum inscribed cylinder (MICY): the optimum next to
/// the least-squares axis, as the standards mean it. A cylinder across a short disc may be smaller;
/// it is not the reference.
///
/// @param points_mm       n >= 5 points that surround the axis in at least two sections [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return as ls_cylinder(); kReferenceAbsent where there is none within a radius (circumscribed:
///         two radii) and 10 deg of the least-squares axis. Same input, same bits.
/// Cost: as ZoneDescent. Sources: ISO 12180-1; methods, cylindricity section 11.4.
[[nodiscard]] core::Result<OneSidedCylinder> min_circumscribed_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);
[[nodiscard]] core::Result<OneSidedCylinder> max_inscribed_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

}  // namespace rondure::fit
