#include "fit/geometry/axis.h"

#include <Eigen/Geometry>

namespace rondure::fit {

Axis conventional(const Axis& axis, const Eigen::Vector3d& mean_mm) {
  Axis out;
  out.direction = axis.direction.normalized();
  Eigen::Index largest = 0;
  out.direction.cwiseAbs().maxCoeff(&largest);
  if (out.direction(largest) < 0.0) out.direction = -out.direction;
  out.point_mm = axis.point_mm + out.direction * (mean_mm - axis.point_mm).dot(out.direction);
  return out;
}

double distance_mm(const Axis& axis, const Eigen::Vector3d& point_mm) {
  return (point_mm - axis.point_mm).cross(axis.direction).norm();
}

Eigen::Matrix<double, 3, 2> across(const Eigen::Vector3d& direction) {
  // The cross product with the coordinate axis least parallel to the direction is conditioned best.
  Eigen::Index smallest = 0;
  direction.cwiseAbs().minCoeff(&smallest);
  Eigen::Matrix<double, 3, 2> frame;
  frame.col(0) = (Eigen::Vector3d::Unit(smallest) - direction * direction(smallest)).normalized();
  frame.col(1) = direction.cross(frame.col(0));
  return frame;
}

}  // namespace rondure::fit
