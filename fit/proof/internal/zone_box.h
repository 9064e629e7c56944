#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include "fit/proof/certificate.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Bounds are rounded outward by this part of the coordinate range.
inline constexpr double kOutward = 1e-12;

/// A set of axes: those that cross the plane z = 0 of a frame in the square
/// |o - center_mm| <= half_side_mm and lean to the frame's z by an angle whose tangent is at most
/// `lean`. With lean 0 these are the centres of a square of the plane.
struct ZoneBox {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double half_side_mm = 0.0;
  double lean = 0.0;
};

/// The same axes in four squares.
[[nodiscard]] std::array<ZoneBox, 4> quarters(const ZoneBox& box);

/// What a linear programme says about the zones of all axes of a box.
struct ZoneBoxBound {
  double lower_mm = 0.0;  ///< No axis of the box has a zone narrower than this [mm].
  bool excluded = false;  ///< lower_mm is above the width asked for. Not of one side.
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< The axis of the box that looks best:
  Eigen::Vector2d tilt = Eigen::Vector2d::Zero();  ///< crosses z = 0 there, direction (tilt, 1).
};

/// Lower bound of the zone over a box, of use where the box is small against the radius.
///
/// With q the offset of a point from the axis in the plane of its height,
///     r^2 = |q|^2 - (q.t)^2 / (1 + |t|^2)       (t: tilt),
/// and a zone of width w <= W has  R^2 <= r^2 (1 + W/g) + W (g + W)  for any g > 0. The left and
/// right side of that are linear in the axis but for products of its parameters. Multipliers of a
/// linear programme over the linear part, any that are >= 0 with sum 1, turn it into one quadratic
/// inequality (weak duality), which is bounded over the box term by term. So an error of the
/// programme costs sharpness only, never truth.
///
/// @param points_mm  In the frame: x, y across its z, height z [mm]. A subset gives a valid bound.
/// @param width_mm   W > 0; the bound is not sought above it.
/// @param tolerance_mm  Bounds this close to the width are told apart from lower ones.
/// @param slack_mm   Rounds outward: the proof must hold with this to spare.
/// K = 2: centres only (lean must be 0); K = 4: axes.
template <int K>
[[nodiscard]] ZoneBoxBound bound_zone_box(std::span<const Eigen::Vector3d> points_mm,
                                          const ZoneBox& box, double width_mm, double tolerance_mm,
                                          double slack_mm);

/// The same for one side: a lower bound of  outer weight * max r - inner weight * min r  over all
/// axes of a box, one of the weights being 0: of the circumscribed radius, or of the inscribed one
/// with its sign changed. Weak duality in r^2 again; there is no width to ask for.
template <int K>
[[nodiscard]] ZoneBoxBound bound_one_sided_box(std::span<const Eigen::Vector3d> points_mm,
                                               const ZoneBox& box, const ZoneWeights& weights,
                                               double slack_mm);

}  // namespace rondure::fit
