#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// The rows that a proof uses: the contacts and some sixty more, spread over the data so that they
/// do not coincide with a period of the scan; all rows of a small set. The zone of some points is a
/// lower bound for the zone of all, so a bound for these rows holds for the data.
class SearchRows {
 public:
  SearchRows(std::size_t count, std::span<const Contact> outer, std::span<const Contact> inner);

  [[nodiscard]] const std::vector<std::size_t>& rows() const { return rows_; }
  /// Adds a row.
  /// @return Whether it was not yet included.
  bool add(std::size_t row);

 private:
  std::vector<bool> taken_;
  std::vector<std::size_t> rows_;
};

/// The farthest and the nearest of some points, and the value of their zone.
struct ExtremeRows {
  std::size_t far = 0;
  std::size_t near = 0;
  double value = 0.0;
};

/// @param square  Squared distance of a point from the centre or axis.
template <class Points, class Square>
[[nodiscard]] ExtremeRows extreme_rows(const Points& points, const Square& square,
                                       const ZoneWeights& weights) {
  ExtremeRows out;
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double here = square(points[i]);
    if (here > high) {
      high = here;
      out.far = i;
    }
    if (here < low) {
      low = here;
      out.near = i;
    }
  }
  out.value = weights.value({std::sqrt(low), std::sqrt(high)});
  return out;
}

/// States why a search that reached its limit proves nothing: "12 squares of centres were left
/// after 40; lower bound 0.0123 mm, 0.0001 mm from the value found".
[[nodiscard]] core::Phrase left_open(std::string_view boxes, std::size_t left, int after,
                                     double lower_mm, double value_mm, const ZoneWeights& weights);

/// Part of the coordinate range by which bounds are rounded outward.
inline constexpr double kOutward = 1e-12;

/// A set of axes: those that cross the plane z = 0 of a frame in the square
/// |o - center_mm| <= half_side_mm and are inclined to its z by an angle whose tangent is at most
/// `lean`. With lean 0 these are the centres in a square of the plane.
struct ZoneBox {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double half_side_mm = 0.0;
  double lean = 0.0;
};

/// Divides the axes of a box among four squares.
[[nodiscard]] std::array<ZoneBox, 4> quarters(const ZoneBox& box);

/// Lower bound that a linear programme gives for the zones of all axes of a box.
struct ZoneBoxBound {
  double lower_mm = 0.0;  ///< No axis of the box has a narrower zone than this [mm].
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< The most promising axis of the box
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< crosses z = 0 here, direction (tilt, 1).
};

/// Lower bound of the zone over a box. It is useful if the box is small compared with the radius.
///
/// With q the offset of a point from the axis in the plane of its height,
///     r^2 = |q|^2 - (q.t)^2 / (1 + |t|^2)       (t: tilt),
/// and a zone of width w <= W has  R^2 <= r^2 (1 + W/g) + W (g + W)  for any g > 0. Both sides of
/// this inequality are linear in the axis except for products of its parameters. The multipliers of
/// a linear programme over the linear part turn it into one quadratic inequality (weak duality),
/// bounded over the box term by term: an error of the programme makes it less sharp, never false.
///
/// @param points_mm  In the frame: x, y across its z, height z [mm]. A subset gives a valid bound.
/// @param width_mm   W > 0; no bound above it is sought.
/// @param tolerance_mm  Bounds this close to the width are distinguished from lower ones.
/// @param slack_mm   Margin with which the proof must hold, for outward rounding.
/// K = 2: centres only (lean must be 0); K = 4: axes.
template <int K>
[[nodiscard]] ZoneBoxBound bound_zone_box(SpacePoints points_mm, const ZoneBox& box,
                                          double width_mm, double tolerance_mm, double slack_mm);

/// The same for one side: a lower bound of  outer weight * max r - inner weight * min r  over all
/// axes of a box, where one of the weights is 0: of the circumscribed radius, or of the negative
/// inscribed radius. Also by weak duality in r^2, but without a width.
template <int K>
[[nodiscard]] ZoneBoxBound bound_one_sided_box(SpacePoints points_mm, const ZoneBox& box,
                                               const ZoneWeights& weights, double slack_mm);

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
