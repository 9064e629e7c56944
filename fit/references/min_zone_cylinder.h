#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/zone/ending.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// Two coaxial cylinders that hold all points between them with the least radial gap (MZCY).
struct MinZoneCylinder {
  Axis axis;
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer cylinder that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  int boxes = 0;                           ///< Boxes of directions that the global search bounded.
  ZoneEnding ending = ZoneEnding::kLimit;  ///< How the descent to the axis ended.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};

/// Finds the minimum-zone cylinder: the least cylindricity deviation CYLt of the points (ISO 1101).
///
/// Descends (ZoneDescent) from the least-squares cylinder, to optima with six contacts and to those
/// with five, which curvature determines. Then searches the scopes of the options for a narrower
/// zone (search_axes()); a better axis becomes the new start, so the proof also serves as the
/// global search.
///
/// @param points_mm       n >= 5 points that surround the axis in at least two sections [mm].
/// @param near_direction  Start direction; without it the half sphere is searched for starts.
/// @return as ls_cylinder(); `ending` and `certificate` state how the search ended. Same input,
///         same bits. O(n) per pivot, some ten pivots per programme.
/// Sources: ISO 1101, ISO 12180-1; methods, cylindricity section 11, certificates section 1.
[[nodiscard]] core::Result<MinZoneCylinder> min_zone_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt,
    const CylinderProofOptions& options = {});

}  // namespace rondure::fit
