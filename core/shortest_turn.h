#pragma once

#include <cmath>

#include <Eigen/Geometry>

namespace rondure::core {

/// The rotation by the smallest angle that turns the direction `from` to that of `to`. Opposite
/// directions (within 1.4 urad) leave its axis open: it is then perpendicular to `from` and y, or z
/// where `from` lies along y. Quaterniond::FromTwoVectors gives the same bits otherwise; for
/// opposite directions it decomposes a matrix, which costs g++ some eight seconds in every file
/// that calls it, and is off by up to 1.5e-8 rad.
/// @pre Neither is zero.
[[nodiscard]] inline Eigen::Matrix3d shortest_turn(const Eigen::Vector3d& from,
                                                   const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double cosine = b.dot(a);
  if (cosine > -1.0 + 1e-12) {
    const double twice_w = std::sqrt((1.0 + cosine) * 2.0);
    const double scale = 1.0 / twice_w;
    const Eigen::Vector3d v = a.cross(b) * scale;
    return Eigen::Quaterniond(twice_w * 0.5, v.x(), v.y(), v.z()).toRotationMatrix();
  }
  // The cosine no longer tells how far they are from opposite. Half a turn, then the small rest.
  Eigen::Vector3d axis(a.z(), 0.0, -a.x());
  axis = axis.squaredNorm() > 0.0 ? axis.normalized() : Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d half = 2.0 * axis * axis.transpose() - Eigen::Matrix3d::Identity();
  return shortest_turn(-a, b) * half;
}

}  // namespace rondure::core
