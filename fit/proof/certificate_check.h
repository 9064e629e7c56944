#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/proof/certificate.h"

namespace rondure::fit {

/// A zone as anyone may state it: the place, the radii, the contacts with their multipliers. A
/// minimum circumscribed or maximum inscribed reference has contacts on its own side only; the
/// other radius is then that of the farthest point on the other side and claims nothing.
struct StatedZone {
  double inner_radius_mm = 0.0;
  double outer_radius_mm = 0.0;
  std::span<const Contact> outer;
  std::span<const Contact> inner;
};

/// What a check by hand finds.
struct ZoneCheck {
  double outside_mm = 0.0;      ///< How far the worst point lies outside the zone.
  double off_contact_mm = 0.0;  ///< How far the worst contact lies off its radius.
  double weight_error = 0.0;    ///< Of the multipliers: how far below 0, or their sums off 1.
  double imbalance = 0.0;       ///< |sum lam grad r_h - sum mu grad r_l|, the worst unknown.
  /// To first order, no place within 1 zone width of this one has a value (the width; of one side:
  /// its radius) better by more than this [mm].
  double gap_mm = 0.0;
  std::string fault;  ///< First condition that does not hold, in words; empty: all hold.
};

/// Checks the witness of a minimum zone. Shares no code with the solvers: distances by cross
/// product, gradients by central differences, in the unknowns a, b, Z tx, Z ty (Z: half the length
/// of the points along the axis). Of a zone with contacts on one side only that side is checked:
/// its points, multipliers and balance. A zone without contacts has nothing to check but that no
/// point is outside.
///
/// @param tolerance_mm  Allowed for distances; 1e-9 of the coordinates' size and more is sensible.
[[nodiscard]] ZoneCheck check_zone(std::span<const Eigen::Vector3d> points_mm, const Axis& axis,
                                   const StatedZone& zone, double tolerance_mm = 1e-9);
[[nodiscard]] ZoneCheck check_zone(std::span<const Eigen::Vector2d> points_mm,
                                   const Eigen::Vector2d& center_mm, const StatedZone& zone,
                                   double tolerance_mm = 1e-9);

}  // namespace rondure::fit
