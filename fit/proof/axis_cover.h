#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// A set of directions: those that pass through a square in the plane z = 1 of a frame.
struct DirectionBox {
  Eigen::Matrix3d frame =
      Eigen::Matrix3d::Identity();  ///< Axes in columns; the third is normal to the plane.
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double half_side = 0.0;

  [[nodiscard]] Eigen::Vector3d middle() const { return direction(0.0, 0.0); }
  /// Largest angle between the middle and a direction of the box [rad], which is that of a corner,
  /// because the box is convex on the sphere.
  [[nodiscard]] double opening_rad() const;
  /// The four boxes with half the side that together hold the same directions.
  [[nodiscard]] std::array<DirectionBox, 4> quarters() const;

 private:
  [[nodiscard]] Eigen::Vector3d direction(double x, double y) const;
};

/// Returns boxes that hold every direction within `cone_rad` of `direction`, of either sign.
/// @pre 0 < cone_rad < 80 deg.
[[nodiscard]] std::vector<DirectionBox> cover_cone(const Eigen::Vector3d& direction,
                                                   double cone_rad);

/// Returns boxes that hold every direction, of either sign: three faces of a cube.
[[nodiscard]] std::vector<DirectionBox> cover_half_sphere();

}  // namespace rondure::fit
