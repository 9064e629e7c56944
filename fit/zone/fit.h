#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/contacts.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/cylinder.h"
#include "fit/zone/descent.h"

namespace rondure::fit {

/// A zone with its contacts, but without a proof of the global optimum, for loops and large data.
/// The functions in fit/references add the proof.
///
/// The weights determine which side is valid: both for a minimum zone, the outer radius for the
/// minimum circumscribed, the inner radius for the maximum inscribed. The other side is then only
/// the extreme distance, without contacts.
template <class Place>
struct ZoneFit {
  Place place{};  ///< Centre, or axis with any of its points [mm].
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  Contacts outer;  ///< Rows in contact, with multipliers >= 0 that sum to 1.
  Contacts inner;
  int passes = 0;                          ///< Passes over all points; 0 if no sample was needed.
  int pivots = 0;                          ///< Pivots of all linear programs.
  ZoneEnding ending = ZoneEnding::kLimit;  ///< Why the descent ended.

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};
using CircleZone = ZoneFit<Eigen::Vector2d>;
using CylinderZone = ZoneFit<Axis>;

/// Fits zones of circles (D = 2) or spheres (D = 3). The search starts at the least-squares circle
/// (algebraic) or sphere of some points spread over the data; see ZoneDescent for the rest and the
/// cost. Circumscribed circles and spheres are convex and start anywhere.
///
/// An object keeps its memory: after the first fit, sets of the same size need no more. The same
/// input gives the same bits, whatever was fitted before.
template <int D>
class CenterZoneFitter {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  /// @return The zone (its `ending` may be kLimit); or kNoPoints, kNotFinite (row), kTooFewPoints,
  ///         kCollinear, kRank, kNotConverged (as the least-squares fits), kUnits for coordinates
  ///         too large to be squared, kReferenceAbsent for a circumscribed or inscribed reference
  ///         that does not exist next to the least-squares one.
  core::Result<ZoneFit<Point>> fit(std::span<const Point> points_mm,
                                   const ZoneWeights& weights = kMinimumZone);
  /// Fits from a given centre and does not check the points.
  /// @pre At least one point.
  /// @return `ending` is kStrayed if the centre went farther than `limit_mm` from the given one.
  ZoneFit<Point> fit_from(std::span<const Point> points_mm, const Point& center_mm,
                          const ZoneWeights& weights = kMinimumZone,
                          double limit_mm = std::numeric_limits<double>::infinity());

 private:
  core::Result<LsCenter<D>> start_of(std::span<const Point> points_mm);

  std::vector<Point> sample_;
  ZoneDescent<CenterFrame<D>> descent_;
};
using CircleZoneFitter = CenterZoneFitter<2>;
using SphereZoneFitter = CenterZoneFitter<3>;

/// Fits zones of cylinders; memory, results and cost as CenterZoneFitter. The search starts at the
/// least-squares cylinder. Few points, or points on part of the circumference, may have several
/// minima: neighbouring axes then serve as further starts.
class CylinderZoneFitter {
 public:
  /// @param near_direction  Start direction; without it the half sphere is searched for starts.
  /// @return As CenterZoneFitter::fit().
  core::Result<CylinderZone> fit(SpacePoints points_mm,
                                 const std::optional<Eigen::Vector3d>& near_direction,
                                 const ZoneWeights& weights = kMinimumZone);
  /// Fits from a given axis, as CenterZoneFitter::fit_from().
  CylinderZone fit_from(SpacePoints points_mm, const Axis& axis,
                        const ZoneWeights& weights = kMinimumZone,
                        double limit_mm = std::numeric_limits<double>::infinity());
  /// The best of `best` and of fits from axes about a given one, eight for each tilt [rad].
  CylinderZone fit_around(SpacePoints points_mm, const Axis& axis, std::span<const double> tilts,
                          CylinderZone best, const ZoneWeights& weights = kMinimumZone,
                          double limit_mm = std::numeric_limits<double>::infinity());
  /// The least-squares cylinder from which the last fit() started; that of a sample if there are
  /// many points.
  [[nodiscard]] const LsCylinder& start() const { return start_; }

 private:
  CylinderZone fit_best(SpacePoints points_mm, const LsCylinder& start, const ZoneWeights& weights);

  LsCylinder start_;
  std::vector<Eigen::Vector3d> sample_;
  ZoneDescent<CylinderFrame> descent_;
};

}  // namespace rondure::fit
