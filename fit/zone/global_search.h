#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/units.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/proof/axis_cover.h"
#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Limits of a global search. They are counts, never times: same input, same result.
struct GlobalSearchOptions {
  int max_boxes = 20000;  ///< Boxes bounded before the search gives up; >= 1.
  /// Boxes are closed this far below the zone, or 4e-12 of the coordinate range if that is more; it
  /// adds to the gap.
  double tolerance_mm = 1e-9;
};

/// Extent of the proof of a minimum-zone or maximum inscribed circle.
struct CenterProofOptions {
  /// Search all centres, as for a reported value; false: local proof only, as inside loops.
  bool global = true;
  GlobalSearchOptions search;
};

/// Directions that are searched for a better axis.
struct AxisScope {
  enum class Kind { kCone, kHalfSphere };
  Kind kind = Kind::kHalfSphere;
  Eigen::Vector3d nominal = Eigen::Vector3d::UnitZ();  ///< Middle of the cone.
  double cone_rad = 10.0 * core::kDegree;              ///< Half angle of the cone, below 80 deg.
};

/// Extent of the proof of a minimum-zone, circumscribed or inscribed cylinder.
struct CylinderProofOptions {
  /// Scopes to try in order until one is proven. Empty: local proof only, as is enough inside
  /// loops.
  std::vector<AxisScope> scopes;
  GlobalSearchOptions search;
  /// Where something is known of the axis, as the layers of the points: a better axis outside of
  /// this cone is no candidate, and ends the search of a wider scope.
  std::optional<AxisScope> candidates = {};
};

/// Most searches of one proof. Each but the first starts at the better place found by the last one.
inline constexpr int kRestartLimit = 200;

/// Region in which a maximum inscribed reference is sought; beyond the points it would grow without
/// bound.
struct AxisReach {
  Axis about;             ///< The least-squares axis.
  double limit_mm = 0.0;  ///< Greatest distance from that axis over the length of the points.
};

/// The result of the solver, whose optimality is to be proven. The value is
/// outer weight * max r - inner weight * min r: the width of a minimum zone, the radius of a
/// circumscribed reference, or the negative radius of an inscribed one.
struct ZoneClaim {
  double value_mm = 0.0;
  double growth = 0.0;  ///< sigma: first-order growth per mm of the contacts below.
  std::span<const Contact> outer;
  std::span<const Contact> inner;
  ZoneWeights weights = kMinimumZone;
  AxisReach reach = {};  ///< For axes of a maximum inscribed reference only.
};

/// Outcome of a search through all centres, or all axes of a scope.
template <class Place>
struct GlobalSearch {
  bool proven = false;          ///< No better place exists; else see `better`, then `reason`.
  double lower_mm = 0.0;        ///< If proven: no value in the scope is below this [mm].
  std::optional<Place> better;  ///< A place with a lower value, from which to solve again.
  int boxes = 0;                ///< Boxes bounded.
  core::Phrase reason;          ///< Why the claim is not proven.
};

/// Proves that no centre of the plane has a lower value than the claim, or finds one that has. For
/// minimum zones, and for maximum inscribed circles with centres inside the hull of the points.
///
/// Branch and bound (zone/internal/zone_box.h) in the square that holds every better centre
/// (zone/internal/center_region.h). Around the optimum, first-order growth, less the curvature
/// K e^2 that could oppose it, closes a square of its own.
///
/// @param points_mm, center_mm  Data and centre of the claim.
/// @return How the search ended: `proven`, or with a `better` centre, or with a `reason`.
/// Source: methods, certificates section 2.
[[nodiscard]] GlobalSearch<Eigen::Vector2d> search_centers(PlanePoints points_mm,
                                                           const Eigen::Vector2d& center_mm,
                                                           const ZoneClaim& claim,
                                                           const GlobalSearchOptions& options = {});

/// The same for axes whose direction is in one of `directions`; for maximum inscribed cylinders
/// only within the reach of the claim.
///
/// Branch and bound over directions. Turning a direction of a box to its middle moves a point by at
/// most |z| sin + rho (1 - cos) of the opening of the box, so the projected points restrict the
/// centres to one square; one linear programme bounds the axes that remain, with four parameters.
/// Around the optimum growth closes a ball; where growth is of second order (five contacts), boxes
/// are closed `tolerance_mm` below the zone.
///
/// @param axis        Axis of the claim, among the directions; its point midway between the ends.
/// @param half_length_mm  Scale of the tilts in claim.growth.
/// @return How the search ended, as search_centers().
/// Source: methods, certificates section 3.
[[nodiscard]] GlobalSearch<Axis> search_axes(SpacePoints points_mm, const Axis& axis,
                                             double half_length_mm, const ZoneClaim& claim,
                                             std::span<const DirectionBox> directions,
                                             const GlobalSearchOptions& options = {});

}  // namespace rondure::fit
