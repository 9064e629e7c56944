#include "fit/cylinder_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rondure::fit {

CylinderFrame::CylinderFrame(const Axis& axis, double half_length_mm)
    : axis_(axis), across_(across(axis.direction)), half_length_(half_length_mm) {}

CylinderFrame CylinderFrame::moved(const Eigen::Vector4d& x_mm) const {
  Axis next;
  next.point_mm = axis_.point_mm + across_ * x_mm.head<2>();
  next.direction = (axis_.direction + across_ * (x_mm.tail<2>() / half_length_)).normalized();
  return {next, half_length_};
}

double CylinderFrame::distance(const Eigen::Vector3d& p) const {
  return (across_.transpose() * (p - axis_.point_mm)).norm();
}

ZoneRow<4> CylinderFrame::row(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d v = p - axis_.point_mm;
  const Eigen::Vector2d q = across_.transpose() * v;
  const double r = q.norm();
  ZoneRow<4> out;
  out.distance = r;
  if (r == 0.0) return out;  // on the axis every direction is alike
  const double lever = v.dot(axis_.direction) / half_length_;
  out.gradient << -q / r, -lever * q / r;
  return out;
}

ContactRow<4> CylinderFrame::contact_row(const Eigen::Vector3d& p, std::size_t index) const {
  const ZoneRow<4> first = row(p);
  ContactRow<4> out{index, first.distance, first.gradient, Eigen::Matrix4d::Zero()};
  if (first.distance == 0.0) return out;
  const Eigen::Vector3d v = p - axis_.point_mm;
  const Eigen::Vector2d n = across_.transpose() * v / first.distance;
  const Eigen::Vector2d m(-n.y(), n.x());
  const double lever = v.dot(axis_.direction) / half_length_;
  Eigen::Vector4d tangential;
  tangential << m, lever * m;
  Eigen::Vector4d tilt;
  tilt << 0.0, 0.0, n / half_length_;
  out.hessian = tangential * tangential.transpose() / first.distance -
                first.distance * tilt * tilt.transpose();
  return out;
}

double half_extent(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& direction) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Eigen::Vector3d& p : points) {
    const double s = p.dot(direction);
    low = std::min(low, s);
    high = std::max(high, s);
  }
  return 0.5 * (high - low);
}

}  // namespace rondure::fit
