#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/certificate.h"
#include "fit/contacts.h"

namespace rondure::fit {

/// A circle that touches the points from one side.
struct OneSidedCircle {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;
  double deviation_mm = 0.0;      ///< Radial peak to valley about the centre [mm].
  std::vector<Contact> contacts;  ///< Points on the circle that carry it; multipliers sum to 1.
  Certificate certificate;
};

/// Minimum circumscribed circle (MCCI): the smallest that holds all points. The problem is convex,
/// so its optimum is the only one: the certificate is global by the contacts alone.
///
/// @param points_mm  n >= 3 distinct points, not on one line [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear. Same input, same bits.
/// Cost: as ZoneDescent. Sources: ISO 12181-1; methods, cylindricity section 11.4.
[[nodiscard]] core::Result<OneSidedCircle> min_circumscribed_circle(
    std::span<const Eigen::Vector2d> points_mm);

/// Maximum inscribed circle (MICI): the largest without a point inside, next to the least-squares
/// circle, as the standards mean it. Several may exist; the certificate is local.
///
/// @return also kReferenceAbsent where the points leave a gap through which it grows without bound.
[[nodiscard]] core::Result<OneSidedCircle> max_inscribed_circle(
    std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::fit
