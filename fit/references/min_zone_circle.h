#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/proof/certificate.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// Two concentric circles that hold all points between them with the least radial gap (MZCI).
struct MinZoneCircle {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer circle that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  int squares = 0;         ///< Squares of centres the global search bounded.
  bool exact_fit = false;  ///< Three distinct points: the deviation is 0 by construction.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// How far a minimum-zone circle is proven.
struct MinZoneCircleOptions {
  /// Search all centres, for a reported value; false inside loops: the local proof only.
  bool global = true;
  GlobalSearchOptions search;
};

/// Finds the minimum-zone circle of one plane section.
///
/// Minimises  f(c) = max |p_i - c| - min |p_i - c|  by the descent of zone_descent.h from the
/// algebraic circle. Then all centres are searched for a narrower zone by branch and bound
/// (global_search.h), or, for up to 40 points whose zone is too wide for it, by the enumeration of
/// all bisector crossings. A better centre found there becomes the start, so the proof is the
/// global search too.
///
/// @param points_mm  n >= 3 distinct points, any order [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints (fewer than 3 distinct), kCollinear. Same
///         input, same bits. A search that reaches its limit, or points that a strip holds as well,
///         leave a local certificate that says so. Cost: zone_descent.h, and some 100 us of proof.
/// Sources: ISO 12181-1 (definition); methods, cylindricity section 9, certificates section 2.
[[nodiscard]] core::Result<MinZoneCircle> min_zone_circle(
    std::span<const Eigen::Vector2d> points_mm, const MinZoneCircleOptions& options = {});

}  // namespace rondure::fit
