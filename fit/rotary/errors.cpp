#include "fit/rotary/errors.h"

namespace rondure::fit {

Eigen::Isometry3d error_motion(const Eigen::Vector3d& t_mm, const Eigen::Vector3d& w_rad) {
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  const double angle = w_rad.norm();
  if (angle > 0.0) out.linear() = Eigen::AngleAxisd(angle, w_rad / angle).toRotationMatrix();
  out.translation() = t_mm;
  return out;
}

Eigen::Isometry3d rotary_motion(const RotaryAxis& axis, double angle_rad,
                                const RotaryErrors& errors) {
  return Eigen::Translation3d(axis.origin_mm) * error_motion(errors.t_mm, errors.w_rad) *
         Eigen::AngleAxisd(angle_rad, axis.direction) * Eigen::Translation3d(-axis.origin_mm);
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d out;
  out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return out;
}

Eigen::Matrix3d point_covariance_mm2(const Matrix6& covariance, const Eigen::Vector3d& p_mm) {
  Matrix36 rows;
  rows << Eigen::Matrix3d::Identity(), -cross_matrix(p_mm);
  return rows * covariance * rows.transpose();
}

}  // namespace rondure::fit
