#pragma once

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/proof/axis_cover.h"
#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Limits of a global search. They are counts, never times: same input, same result.
struct GlobalSearchOptions {
  int max_boxes = 20000;       ///< Boxes bounded before the search gives up; >= 1.
  double tolerance_mm = 1e-9;  ///< Boxes are closed this far below the zone, or 4e-12 of the
                               ///< coordinate range, if that is more; enters the gap.
};

/// Searches of one proof: each but the first starts from the better place that the last one met.
inline constexpr int kRestartLimit = 200;

/// Where a maximum inscribed reference is sought: past the points it would grow without bound.
struct AxisReach {
  Axis about;             ///< The least-squares axis.
  double limit_mm = 0.0;  ///< How far from it, over the length of the points.
};

/// What a zone is compared with: the solver's result. What is minimised is
/// outer weight * max r - inner weight * min r: the width of a minimum zone, the radius of a
/// circumscribed reference, that of an inscribed one with its sign changed.
struct ZoneClaim {
  double value_mm = 0.0;
  double growth = 0.0;  ///< sigma: first-order growth per mm, of the contacts below.
  std::span<const Contact> outer;
  std::span<const Contact> inner;
  ZoneWeights weights = kMinimumZone;
  AxisReach reach = {};  ///< Of axes, maximum inscribed only.
};

/// Outcome of a search through all centres, or all axes of a scope.
template <class Place>
struct GlobalSearch {
  bool proven = false;          ///< Nothing better exists; else see `better`, then `reason`.
  double lower_mm = 0.0;        ///< Proven: no value of the scope is below this [mm].
  std::optional<Place> better;  ///< A place with a lower value: solve again from there.
  int boxes = 0;                ///< Boxes bounded.
  std::string reason;           ///< Why it is not proven.
};

/// Proves that no centre of the plane has a lower value than the claim, or finds one that has.
/// Minimum zones and maximum inscribed circles; of these the centres inside the hull of the points.
///
/// The centres that can be better lie in one square (center_region.h). It is searched by branch and
/// bound (zone_box.h); around the optimum itself first-order growth, less the
/// curvature K e^2 that could oppose it, closes a square of its own.
///
/// @param points_mm  The data of the claim.
/// @param center_mm  Centre of the claim.
/// Source: methods, certificates section 2.
[[nodiscard]] GlobalSearch<Eigen::Vector2d> search_centers(
    std::span<const Eigen::Vector2d> points_mm, const Eigen::Vector2d& center_mm,
    const ZoneClaim& claim, const GlobalSearchOptions& options = {});

/// Proves that no axis whose direction is in one of `directions` has a lower value than the claim,
/// or finds one. Of maximum inscribed cylinders: no axis within the reach of the claim.
///
/// Branch and bound over directions. Turning a box of directions to its middle moves no point by
/// more than |z| sin + rho (1 - cos) of its opening, so the projected points leave a square of
/// centres at most (center_region.h); what is left, four parameters of the axis, is bounded by one
/// linear programme (zone_box.h). Around the optimum first-order growth, less the curvature K e^2,
/// closes a ball; where growth is of second order (five contacts) boxes are closed `tolerance_mm`
/// below the zone.
///
/// @param axis        Axis of the claim, among the directions; its point midway between the ends.
/// @param half_length_mm  Scale of the tilts in claim.growth.
/// Source: methods, certificates section 3.
[[nodiscard]] GlobalSearch<Axis> search_axes(std::span<const Eigen::Vector3d> points_mm,
                                             const Axis& axis, double half_length_mm,
                                             const ZoneClaim& claim,
                                             std::span<const DirectionBox> directions,
                                             const GlobalSearchOptions& options = {});

}  // namespace rondure::fit
