#pragma once

// Least squares by Ceres with automatic differentiation; the file that includes Ceres is
// ceres_fits.cpp. Radial distances in the plane and in space, nothing shared with the fits.

#include <span>

#include <Eigen/Core>

namespace rondure::test {

struct CeresCircle {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;
};

struct CeresCylinder {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double radius_mm = 0.0;
};

/// @param start  Start of the search; the points are taken relative to it.
[[nodiscard]] CeresCircle ceres_circle(std::span<const Eigen::Vector2d> points_mm,
                                       const CeresCircle& start);
[[nodiscard]] CeresCylinder ceres_cylinder(std::span<const Eigen::Vector3d> points_mm,
                                           const CeresCylinder& start);

}  // namespace rondure::test
