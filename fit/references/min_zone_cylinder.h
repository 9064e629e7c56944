#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/axis_scope.h"
#include "fit/proof/certificate.h"
#include "fit/zone/ending.h"

namespace rondure::fit {

/// Two coaxial cylinders that hold all points between them with the least radial gap (MZCY).
struct MinZoneCylinder {
  Axis axis;
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::vector<Contact> outer;  ///< Points on the outer cylinder that carry the minimum.
  std::vector<Contact> inner;
  Certificate certificate;
  int linear_programs = 0;  ///< Linear programs solved: of every start and every restart.
  int boxes = 0;            ///< Boxes of directions the global search bounded.
  ZoneEnding ending = ZoneEnding::kLimit;  ///< Of the descent that led to the axis.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
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
    const CylinderProofOptions& options = {});

}  // namespace rondure::fit
