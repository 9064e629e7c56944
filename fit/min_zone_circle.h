#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/certificate.h"

namespace rondure::fit {

/// Two concentric circles that hold all points between them with the least radial gap (MZCI).
struct MinZoneCircle {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer circle that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  bool exact_fit = false;  ///< Three distinct points: the deviation is 0 by construction.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// Finds the minimum-zone circle of one plane section.
///
/// Minimises  f(c) = max |p_i - c| - min |p_i - c|.  Corrected centre search (center_search.h) from
/// the algebraic circle; a linear programme, re-linearised, where that search does not end at a
/// stationary point; for up to 40 points on a full section the enumeration of all bisector
/// crossings proves the minimum global.
///
/// @param points_mm  n >= 3 distinct points, any order [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints (fewer than 3 distinct), kCollinear,
///         kNotConverged. Same input, same bits. O(n) a step; the enumeration costs n^5/8.
/// Sources: ISO 12181-1 (definition); methods, cylindricity sections 7 and 9.
[[nodiscard]] core::Result<MinZoneCircle> min_zone_circle(
    std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::fit
