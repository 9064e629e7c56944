#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/units.h"
#include "fit/axis.h"
#include "fit/certificate.h"
#include "fit/global_search.h"

namespace rondure::fit {

/// Two coaxial cylinders that hold all points between them with the least radial gap (MZCY).
struct MinZoneCylinder {
  Axis axis;
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer cylinder that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  int programmes = 0;  ///< Linear programmes solved by the descent.
  int boxes = 0;       ///< Boxes of directions the global search bounded.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// Directions searched for a narrower zone.
struct AxisScope {
  enum class Kind { kCone, kHalfSphere };
  Kind kind = Kind::kHalfSphere;
  Eigen::Vector3d nominal = Eigen::Vector3d::UnitZ();  ///< Middle of the cone.
  double cone_rad = 10.0 * core::kDegree;              ///< Half angle of the cone, below 80 deg.
};

/// How far a minimum-zone cylinder is proven.
struct MinZoneCylinderOptions {
  /// Scopes tried in order until one is proven. Empty: the local proof only, for values inside
  /// loops.
  std::vector<AxisScope> scopes;
  GlobalSearchOptions search;
};

/// Finds the minimum-zone cylinder: the least cylindricity deviation CYLt of the points (ISO 1101).
///
/// Starts at the least-squares cylinder; solves the zone linearised about the current axis (two
/// shifts, two tilts) as a linear programme inside a trust region, moves, repeats; ends with Newton
/// on the stationarity equations of the contacts, so that optima with five contacts, held by
/// curvature, are reached like those with six. The local certificate is checked at the end. Then
/// the scopes of the options are searched for a narrower zone (global_search.h); a better axis
/// found there becomes the start, so the proof is the global search too.
///
/// @param points_mm       n >= 5 points that surround the axis in at least two sections [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return as ls_cylinder(). Same input, same bits. O(n) a pivot, some ten pivots a programme.
/// Sources: ISO 1101, ISO 12180-1; methods, cylindricity section 11, certificates section 1.
[[nodiscard]] core::Result<MinZoneCylinder> min_zone_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const MinZoneCylinderOptions& options = {});

}  // namespace rondure::fit
