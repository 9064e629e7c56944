#pragma once

#include <Eigen/Core>

namespace rondure::fit {

/// A plane in space. The normal is a unit vector that points out of the material; where the side is
/// unknown, its largest component (in absolute value) is positive.
struct Plane {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

/// Height of a point above the plane, along the normal [mm].
[[nodiscard]] inline double height_mm(const Plane& plane, const Eigen::Vector3d& point_mm) {
  return (point_mm - plane.point_mm).dot(plane.normal);
}

}  // namespace rondure::fit
