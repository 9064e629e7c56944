#pragma once

#include <Eigen/Core>

#include "fit/geometry/points.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Region of the plane in which the centre of a narrow zone can lie.
struct CenterRegion {
  enum class Kind {
    kEmpty,      ///< There is none: every centre has a wider zone.
    kSquare,     ///< The square |c - center_mm| <= half_side_mm, in each coordinate.
    kUnbounded,  ///< There is no bound: the zone may be a strip.
  };
  Kind kind = Kind::kUnbounded;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double half_side_mm = 0.0;
};

/// Bounds the centres, anywhere in the plane, whose zone is at most `width_mm` wide.
///
/// The area of the annulus about a centre, A = max |p - c|^2 - min |p - c|^2, is convex and
/// piecewise linear in c: one linear programme finds its least value A0 and its growth s in every
/// direction. A zone of width w with inner radius r has A = w (2 r + w), and r grows by at most the
/// move of the centre; if s is larger than that allows, both inequalities together confine the
/// centre to a square. This holds for arcs and for projections along any direction.
///
/// @param points_mm  At least one; a subset of the data gives a valid, larger region.
/// @param width_mm   > 0, already rounded outward. O(n) per pivot, some eight pivots.
[[nodiscard]] CenterRegion center_region(PlanePoints points_mm, double width_mm);

/// Narrows a square of centres to those from which every point is within `radius_mm` (minimum
/// circumscribed), or none is (maximum inscribed). Distances are bounded by their growth from the
/// middle of the square, for the points that are nearly extreme there.
///
/// @param weights    One of them is 0.
/// @param radius_mm  Already rounded outward.
/// @return kEmpty or kSquare; the bound is tight if the middle is near the best centre.
[[nodiscard]] CenterRegion one_sided_region(PlanePoints points_mm, const ZoneWeights& weights,
                                            double radius_mm, const Eigen::Vector2d& center_mm,
                                            double half_side_mm);

}  // namespace rondure::fit
