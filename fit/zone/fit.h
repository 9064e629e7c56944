#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/least_squares/cylinder.h"
#include "fit/zone/contacts.h"
#include "fit/zone/descent.h"

namespace rondure::fit {

/// A zone with its witness, without a proof that it is the best of all: what loops and large data
/// need. The functions that report (min_zone_circle.h, ...) add the proof.
///
/// Which side means something depends on the weights: both for a minimum zone; the outer radius for
/// the minimum circumscribed, the inner one for the maximum inscribed. The other side is then only
/// the extreme distance, without contacts.
template <class Place>
struct ZoneFit {
  Place place{};  ///< Centre, or axis with any of its points [mm].
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  Contacts outer;  ///< Rows that touch, with multipliers >= 0 that sum to 1.
  Contacts inner;
  int passes = 0;           ///< Over all points; 0 where all are worked on at once.
  int linear_programs = 0;  ///< Linear programs solved, those of every start.
  int pivots = 0;           ///< Their pivots.
  ZoneEnding ending = ZoneEnding::kLimit;

  [[nodiscard]] double width_mm() const { return outer_radius_mm - inner_radius_mm; }
};
using CircleZone = ZoneFit<Eigen::Vector2d>;
using SphereZone = ZoneFit<Eigen::Vector3d>;
using CylinderZone = ZoneFit<Axis>;

/// Fits zones of one shape. An object keeps its memory: once it has seen a set, sets of that size
/// need no more. Same input, same bits, whatever was fitted before.
///
/// Starts at the least-squares circle (algebraic), sphere or cylinder of at most some hundred
/// points spread over the data; see ZoneDescent for the rest and the cost. Few points, or points on
/// part of the circumference, may have several minima: then neighbouring axes are starts too.
/// Circumscribed circles and spheres are convex and start anywhere.
///
/// fit_from() starts at a place the caller knows; `ending` tells when it went farther than
/// `limit_mm` from there. fit() returns the zone; or kNoPoints, kNotFinite (row), kTooFewPoints,
/// kCollinear, kRank (as the least-squares fits); kReferenceAbsent for a circumscribed or inscribed
/// reference that does not exist next to the least-squares one.
/// Where the search for a centre starts.
template <int D>
struct CenterStart {
  Eigen::Matrix<double, D, 1> center_mm = Eigen::Matrix<double, D, 1>::Zero();
  double radius_mm = 0.0;
};

template <int D>
class CenterZoneFitter {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  core::Result<ZoneFit<Point>> fit(std::span<const Point> points_mm,
                                   const ZoneWeights& weights = kMinimumZone);
  /// From a given centre, whatever the points.
  ZoneFit<Point> fit_from(std::span<const Point> points_mm, const Point& center_mm,
                          const ZoneWeights& weights = kMinimumZone,
                          double limit_mm = std::numeric_limits<double>::infinity());

 private:
  core::Result<CenterStart<D>> start_of(std::span<const Point> points_mm);

  std::vector<Point> sample_;
  ZoneDescent<CenterFrame<D>> descent_;
};
using CircleZoneFitter = CenterZoneFitter<2>;
using SphereZoneFitter = CenterZoneFitter<3>;

class CylinderZoneFitter {
 public:
  /// @param near_direction  Start direction; without it the half sphere is searched for starts.
  core::Result<CylinderZone> fit(std::span<const Eigen::Vector3d> points_mm,
                                 const std::optional<Eigen::Vector3d>& near_direction,
                                 const ZoneWeights& weights = kMinimumZone);
  /// From a given axis, whatever the points.
  CylinderZone fit_from(std::span<const Eigen::Vector3d> points_mm, const Axis& axis,
                        const ZoneWeights& weights = kMinimumZone,
                        double limit_mm = std::numeric_limits<double>::infinity());
  /// The least-squares cylinder from which the last fit() started: of a sample where points are
  /// many.
  [[nodiscard]] const LsCylinder& start() const { return start_; }

 private:
  CylinderZone fit_best(std::span<const Eigen::Vector3d> points_mm, const LsCylinder& start,
                        const ZoneWeights& weights);

  LsCylinder start_;
  std::vector<Eigen::Vector3d> sample_;
  ZoneDescent<CylinderFrame> descent_;
};

extern template class CenterZoneFitter<2>;
extern template class CenterZoneFitter<3>;

}  // namespace rondure::fit
