#include "fit/cylinder_frame.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"
#include "fit/column_extremes.h"

namespace rondure::fit {
namespace {

const double kLeast = std::cos(10.0 * core::kDegree);

}  // namespace

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

Axis CylinderFrame::place(const Eigen::Vector3d& origin) const {
  return {origin + axis_.point_mm, axis_.direction};
}

CylinderFrame CylinderFrame::snapped(const Eigen::Vector3d& origin) const {
  CylinderFrame out = *this;
  out.axis_.point_mm = place(origin).point_mm - origin;
  return out;
}

bool CylinderFrame::strayed(const CylinderFrame& from, double limit_mm) const {
  if (std::isinf(limit_mm)) return false;
  const bool far =
      !((across_.transpose() * (axis_.point_mm - from.axis_.point_mm)).norm() <= limit_mm);
  return far || axis_.direction.dot(from.axis_.direction) < kLeast;
}

ContactRow<4> CylinderFrame::contact_row(const Eigen::Vector3d& p, std::size_t index) const {
  const Eigen::Vector3d v = p - axis_.point_mm;
  const Eigen::Vector2d q = across_.transpose() * v;
  const double r = q.norm();
  ContactRow<4> out{index, r, Eigen::Vector4d::Zero(), Eigen::Matrix4d::Zero()};
  if (r == 0.0) return out;  // on the axis every direction is alike
  const Eigen::Vector2d n = q / r;
  const Eigen::Vector2d m(-n.y(), n.x());
  const double lever = v.dot(axis_.direction) / half_length_;
  out.gradient << -n, -lever * n;
  Eigen::Vector4d tangential;
  tangential << m, lever * m;
  Eigen::Vector4d tilt;
  tilt << 0.0, 0.0, n / half_length_;
  out.hessian = tangential * tangential.transpose() / r - r * tilt * tilt.transpose();
  return out;
}

Extremes CylinderFrame::linearise(const WorkingPoints<3>& points, ZoneRows<4>& rows) const {
  const std::size_t count = points.size();
  rows.resize(count);
  // Different vectors, which only __restrict tells the compiler; else the loop stays scalar.
  const double* __restrict px = points.column(0);
  const double* __restrict py = points.column(1);
  const double* __restrict pz = points.column(2);
  double* __restrict distance = rows.distances().data();
  double* __restrict shift_a = rows.gradients(0).data();
  double* __restrict shift_b = rows.gradients(1).data();
  double* __restrict tilt_a = rows.gradients(2).data();
  double* __restrict tilt_b = rows.gradients(3).data();
  const Eigen::Vector3d o = axis_.point_mm;
  const Eigen::Vector3d a = across_.col(0);
  const Eigen::Vector3d b = across_.col(1);
  const Eigen::Vector3d t = axis_.direction / half_length_;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = px[i] - o[0];
    const double y = py[i] - o[1];
    const double z = pz[i] - o[2];
    const double qa = x * a[0] + y * a[1] + z * a[2];
    const double qb = x * b[0] + y * b[1] + z * b[2];
    const double lever = x * t[0] + y * t[1] + z * t[2];
    const double r = std::sqrt(qa * qa + qb * qb);
    // On the axis every direction is alike.
    const double back = r > 0.0 ? -1.0 / r : 0.0;
    const double along_a = back * qa;
    const double along_b = back * qb;
    distance[i] = r;
    shift_a[i] = along_a;
    shift_b[i] = along_b;
    tilt_a[i] = lever * along_a;
    tilt_b[i] = lever * along_b;
  }
  const ColumnExtremes extremes = column_extremes(rows.distances());
  return {extremes.low, extremes.high};
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
