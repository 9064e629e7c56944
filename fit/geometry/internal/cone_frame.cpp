#include "fit/geometry/internal/cone_frame.h"

#include <cmath>

namespace rondure::fit {

double ConeFrame::distance(const Eigen::Vector3d& p) const {
  const double h = (p - axis().point_mm).dot(axis().direction);
  return frame_.distance(p) * std::cos(half_angle_) - h * std::sin(half_angle_);
}

std::pair<double, ConeFrame::Step> ConeFrame::slope(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d v = p - axis().point_mm;
  const Eigen::Vector2d q = frame_.across_axis().transpose() * v;
  const double e = q.norm();
  const double h = v.dot(axis().direction);
  const double c = std::cos(half_angle_);
  const double s = std::sin(half_angle_);
  const double along = h * c + e * s;
  // No direction is distinguished on the axis.
  const Eigen::Vector2d n = e > 0.0 ? Eigen::Vector2d(q / e) : Eigen::Vector2d::Zero();
  Step gradient;
  gradient << -n, -along / length_mm() * n, -along / length_mm();
  return {e * c - h * s, gradient};
}

ContactRow<ConeFrame::kUnknowns> ConeFrame::contact_row(const Eigen::Vector3d& p,
                                                        std::size_t index) const {
  const auto [value, gradient] = slope(p);
  ContactRow<kUnknowns> out{index, value, gradient, Eigen::Matrix<double, 5, 5>::Zero()};
  const double z = length_mm();
  const double c = std::cos(half_angle_);
  const double s = std::sin(half_angle_);
  const double h = (p - axis().point_mm).dot(axis().direction);
  const ContactRow<4> radial = frame_.contact_row(p, index);
  // The height turns with the axis: h + (q - shift) . tilt - h tilt^2 / 2.
  Eigen::Matrix4d height = Eigen::Matrix4d::Zero();
  height.topRightCorner<2, 2>() = -Eigen::Matrix2d::Identity() / z;
  height.bottomLeftCorner<2, 2>() = -Eigen::Matrix2d::Identity() / z;
  height.bottomRightCorner<2, 2>() = -h / (z * z) * Eigen::Matrix2d::Identity();
  Eigen::Vector4d rise = Eigen::Vector4d::Zero();
  rise.tail<2>() = frame_.across_axis().transpose() * (p - axis().point_mm) / z;
  out.hessian.topLeftCorner<4, 4>() = c * radial.hessian - s * height;
  out.hessian.topRightCorner<4, 1>() = -(s * radial.gradient + c * rise) / z;
  out.hessian.bottomLeftCorner<1, 4>() = out.hessian.topRightCorner<4, 1>().transpose();
  out.hessian(4, 4) = -value / (z * z);
  out.hessian.topRows<2>() /= c;
  out.hessian.leftCols<2>() /= c;
  return out;
}

ConeFrame ConeFrame::moved(const Step& x_mm) const {
  ConeFrame out = *this;
  Eigen::Vector4d axis_step = x_mm.head<4>();
  axis_step.head<2>() /= std::cos(half_angle_);
  out.frame_ = frame_.moved(axis_step);
  out.half_angle_ += x_mm(4) / length_mm();
  return out;
}

}  // namespace rondure::fit
