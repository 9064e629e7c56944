#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/cone.h"
#include "fit/proof/certificate.h"
#include "fit/zone/ending.h"

namespace rondure::fit {

/// Two cones with one axis and one angle that hold all points between them with the least distance.
struct MinZoneCone {
  Cone cone;                   ///< Midway between the two.
  double width_mm = 0.0;       ///< Form deviation of the cone, normal to the surface [mm].
  std::vector<Contact> outer;  ///< Points on the cone away from the axis that carry the minimum.
  std::vector<Contact> inner;
  /// Local at best: next to the least-squares cone. None where one generatrix holds the zone: then
  /// other cones are as good to `gap_mm`.
  Certificate certificate;
  ZoneEnding ending = ZoneEnding::kLimit;  ///< How the descent ended.
};

/// Finds the minimum-zone cone next to the least-squares cone, with a free angle: up to seven
/// contacts (CoupledDescent with five unknowns).
///
/// @param points_mm, near_direction  As ls_cone().
/// @return as ls_cone(); `ending` and `certificate` state how the search ended. O(n) per step.
/// Source: methods, drawing section 9.2; certificates section 1 with one more row.
[[nodiscard]] core::Result<MinZoneCone> min_zone_cone(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction = std::nullopt);

}  // namespace rondure::fit
