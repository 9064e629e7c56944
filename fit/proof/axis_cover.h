#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// A set of directions: those through a square of the plane z = 1 of a frame.
struct DirectionBox {
  Eigen::Matrix3d frame =
      Eigen::Matrix3d::Identity();  ///< Columns; the plane's normal is the third.
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double half_side = 0.0;

  [[nodiscard]] Eigen::Vector3d middle() const { return direction(0.0, 0.0); }
  /// Largest angle between the middle and a direction of the box [rad]: it is at a corner, because
  /// the box is convex on the sphere.
  [[nodiscard]] double opening_rad() const;
  [[nodiscard]] std::array<DirectionBox, 4> quarters() const;

 private:
  [[nodiscard]] Eigen::Vector3d direction(double x, double y) const;
};

/// Boxes that hold every direction within `cone_rad` (below 80 deg) of one, either way round.
[[nodiscard]] std::vector<DirectionBox> cover_cone(const Eigen::Vector3d& direction,
                                                   double cone_rad);

/// Boxes that hold every direction, either way round: three faces of a cube.
[[nodiscard]] std::vector<DirectionBox> cover_half_sphere();

}  // namespace rondure::fit
