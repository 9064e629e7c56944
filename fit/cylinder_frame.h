#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/axis.h"
#include "fit/local_certificate.h"
#include "fit/zone_program.h"

namespace rondure::fit {

/// An axis under iteration with the four unknowns that move it, all in mm: shifts a, b across it
/// and tilts scaled by the half length Z of the points, x = (a, b, Z tx, Z ty). The frame follows
/// the axis, so the linearisation is always at tilt 0.
///
/// Points are given relative to their mean. Source: methods, certificates section 1.
class CylinderFrame {
 public:
  /// @param half_length_mm  Z > 0: the scale of the tilts.
  CylinderFrame(const Axis& axis, double half_length_mm);

  [[nodiscard]] const Axis& axis() const { return axis_; }
  [[nodiscard]] double half_length_mm() const { return half_length_; }
  /// Two unit vectors across the axis, along which a and b are measured.
  [[nodiscard]] const Eigen::Matrix<double, 3, 2>& across_axis() const { return across_; }
  /// The axis after a move x.
  [[nodiscard]] CylinderFrame moved(const Eigen::Vector4d& x_mm) const;

  [[nodiscard]] double distance(const Eigen::Vector3d& p) const;
  /// Distance and gradient.
  [[nodiscard]] ZoneRow<4> row(const Eigen::Vector3d& p) const;
  /// The same with the second derivative.
  [[nodiscard]] ContactRow<4> contact_row(const Eigen::Vector3d& p, std::size_t index) const;

 private:
  Axis axis_;
  Eigen::Matrix<double, 3, 2> across_;
  double half_length_;
};

/// Half the extent of the points along a direction [mm].
[[nodiscard]] double half_extent(std::span<const Eigen::Vector3d> points,
                                 const Eigen::Vector3d& direction);

}  // namespace rondure::fit
