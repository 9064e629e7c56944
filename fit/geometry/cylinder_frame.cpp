#include "fit/geometry/cylinder_frame.h"

#include <cmath>

#include "core/units.h"

namespace rondure::fit {
namespace {

const double kLeast = std::cos(10.0 * core::kDegree);

/// A cylinder frame as plain numbers: origin, two directions across, axis divided by half length.
struct Numbers {
  const double* o;
  const double* a;
  const double* b;
  const double* t;
};

/// The loop of linearise(). It is a separate function with columns that do not overlap, because
/// only then the compiler computes two square roots at a time.
[[gnu::noinline]] void linearise_columns(std::size_t count, const double* __restrict px,
                                         const double* __restrict py, const double* __restrict pz,
                                         const Numbers& frame, double* __restrict distance,
                                         double* __restrict shift_a, double* __restrict shift_b,
                                         double* __restrict tilt_a, double* __restrict tilt_b) {
  const double ox = frame.o[0], oy = frame.o[1], oz = frame.o[2];
  const double ax = frame.a[0], ay = frame.a[1], az = frame.a[2];
  const double bx = frame.b[0], by = frame.b[1], bz = frame.b[2];
  const double tx = frame.t[0], ty = frame.t[1], tz = frame.t[2];
  for (std::size_t i = 0; i < count; ++i) {
    const double x = px[i] - ox;
    const double y = py[i] - oy;
    const double z = pz[i] - oz;
    const double qa = x * ax + y * ay + z * az;
    const double qb = x * bx + y * by + z * bz;
    const double lever = x * tx + y * ty + z * tz;
    const double r = std::sqrt(qa * qa + qb * qb);
    // No direction is distinguished on the axis.
    const double back = r > 0.0 ? -1.0 / r : 0.0;
    distance[i] = r;
    shift_a[i] = back * qa;
    shift_b[i] = back * qb;
    tilt_a[i] = lever * (back * qa);
    tilt_b[i] = lever * (back * qb);
  }
}

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
  if (r == 0.0) return out;  // no direction is distinguished on the axis
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
  rows.resize(points.size());
  const Eigen::Vector3d along = axis_.direction / half_length_;
  linearise_columns(points.size(), points.column(0), points.column(1), points.column(2),
                    {axis_.point_mm.data(), across_.data(), across_.data() + 3, along.data()},
                    rows.distances().data(), rows.gradients(0).data(), rows.gradients(1).data(),
                    rows.gradients(2).data(), rows.gradients(3).data());
  return column_extremes(rows.distances());
}

double half_extent(SpacePoints points, const Eigen::Vector3d& direction) {
  return 0.5 * extremes_of(points, [&](const auto& p) { return p.dot(direction); }).width();
}

}  // namespace rondure::fit
