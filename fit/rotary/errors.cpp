#include "fit/rotary/errors.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

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

Matrix6 turn_covariance(const Eigen::Vector3d& direction, const Eigen::Vector3d& through_mm,
                        double u_rad) {
  Vector6 v;
  v << -direction.cross(through_mm), direction;
  return u_rad * u_rad * v * v.transpose();
}

Matrix6 setup_covariance(std::span<const Eigen::Vector3d> p_mm, const RotaryAxis& axis,
                         double turned_rad, double repeat_rad, double tool_mm) {
  const Eigen::Matrix3d turn = axis.turn(turned_rad);
  const Eigen::Matrix<double, 3, 2> tool =
      tool_mm * (turn - Eigen::Matrix3d::Identity()).rightCols<2>();
  Matrix6 normal = Matrix6::Zero();
  Matrix6 sum = Matrix6::Zero();
  for (const Eigen::Vector3d& p : p_mm) {
    const Eigen::Vector3d here = turn * p;
    Matrix36 rows;
    rows << Eigen::Matrix3d::Identity(), -cross_matrix(here);
    const Eigen::Vector3d repeat = repeat_rad * axis.direction.cross(here);
    normal += rows.transpose() * rows;
    sum += rows.transpose() * (tool * tool.transpose() + repeat * repeat.transpose()) * rows;
  }
  const Matrix6 inverse = normal.inverse();
  return inverse * sum * inverse;
}

Matrix6 turned_covariance(const Matrix6& covariance, const Eigen::Matrix3d& turn) {
  Matrix6 both = Matrix6::Zero();
  both.topLeftCorner<3, 3>() = turn;
  both.bottomRightCorner<3, 3>() = turn;
  return both * covariance * both.transpose();
}

double station_gate_rad(double lever_mm, const StationGateOptions& options) {
  constexpr double kShare = 0.1;  // of the uncertainty wanted
  return kShare * options.point_u_mm /
         (options.order * (options.shift_mm + options.tilt_rad * lever_mm));
}

double largest_lever_mm(std::span<const Eigen::Vector3d> balls_mm,
                        const Eigen::Vector3d& offset_mm) {
  double out = 0.0;
  for (const Eigen::Vector3d& ball : balls_mm) {
    out = std::max({out, ball.norm(), (offset_mm + ball).norm()});
  }
  return out;
}

double drive_gate_rad(double count_rad, double repeatability_rad, double dead_band_rad) {
  // A command and a reading, each rounded to a count: variance q^2 / 12 each.
  return 4.0 * std::sqrt(count_rad * count_rad / 6.0 + repeatability_rad * repeatability_rad) +
         dead_band_rad;
}

}  // namespace rondure::fit
