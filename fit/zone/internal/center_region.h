#pragma once

#include <span>

#include <Eigen/Core>

#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Where in the plane the centre of a narrow zone can be.
struct CenterRegion {
  enum class Kind {
    kEmpty,      ///< Nowhere: every centre has a wider zone.
    kSquare,     ///< In the square |c - center_mm| <= half_side_mm, in each coordinate.
    kUnbounded,  ///< Nothing can be said: the zone may be a strip.
  };
  Kind kind = Kind::kUnbounded;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double half_side_mm = 0.0;
};

/// Bounds all centres whose zone is at most `width_mm` wide, anywhere in the plane.
///
/// The area of the annulus about a centre, A = max |p - c|^2 - min |p - c|^2, is convex and
/// piecewise linear in c: one linear programme finds its least value A0 and its growth s on every
/// side. A zone of width w with inner radius r has A = w (2 r + w), and r grows by no more than the
/// centre moves; where s is larger than that allows, both inequalities leave a square only. Holds
/// for arcs and for projections along any direction.
///
/// @param points_mm  At least one; a subset of the data gives a valid, larger region.
/// @param width_mm   > 0, already rounded outward. O(n) a pivot, some eight pivots.
[[nodiscard]] CenterRegion center_region(std::span<const Eigen::Vector2d> points_mm,
                                         double width_mm);

/// Narrows a square of centres to those about which every point is within `radius_mm` (minimum
/// circumscribed), or none is (maximum inscribed): distances are bounded by their growth from the
/// middle of the square, for the points near the extreme there.
///
/// @param weights    One of them is 0.
/// @param radius_mm  Already rounded outward.
/// @return kEmpty or kSquare; sharp where the middle is near the best centre.
[[nodiscard]] CenterRegion one_sided_region(std::span<const Eigen::Vector2d> points_mm,
                                            const ZoneWeights& weights, double radius_mm,
                                            const Eigen::Vector2d& center_mm, double half_side_mm);

}  // namespace rondure::fit
