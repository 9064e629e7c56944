#pragma once

#include <array>

#include <Eigen/Core>

#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

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

}  // namespace rondure::fit
