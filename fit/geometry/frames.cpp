#include "fit/geometry/frames.h"

#include <cmath>

#include "core/units.h"

namespace rondure::fit {

template <int D>
ContactRow<D> CenterFrame<D>::contact_row(const Point& p, std::size_t index) const {
  const Point v = p - center_;
  const double r = v.norm();
  ContactRow<D> out{index, r, Point::Zero(), Eigen::Matrix<double, D, D>::Zero()};
  if (r == 0.0) return out;  // no direction is distinguished at the centre
  const Point n = v / r;
  out.gradient = -n;
  out.hessian = (Eigen::Matrix<double, D, D>::Identity() - n * n.transpose()) / r;
  return out;
}

template <int D>
Extremes CenterFrame<D>::linearise(const WorkingPoints<D>& points, ZoneRows<D>& rows) const {
  const std::size_t count = points.size();
  rows.resize(count);
  // __restrict states that the vectors do not overlap; without it the loop stays scalar. In the
  // plane the last of each three is not used.
  const double* __restrict px = points.column(0);
  const double* __restrict py = points.column(1);
  [[maybe_unused]] const double* __restrict pz = points.column(D - 1);
  double* __restrict distance = rows.distances().data();
  double* __restrict along_x = rows.gradients(0).data();
  double* __restrict along_y = rows.gradients(1).data();
  [[maybe_unused]] double* __restrict along_z = rows.gradients(D - 1).data();
  // Plain numbers, because matrices of Eigen would keep the loop scalar as well.
  const double cx = center_[0];
  const double cy = center_[1];
  [[maybe_unused]] const double cz = center_[D - 1];
  for (std::size_t i = 0; i < count; ++i) {
    const double x = cx - px[i];
    const double y = cy - py[i];
    double square = x * x + y * y;
    if constexpr (D == 3) square += (cz - pz[i]) * (cz - pz[i]);
    const double r = std::sqrt(square);
    // No direction is distinguished at the centre.
    const double unit = r > 0.0 ? 1.0 / r : 0.0;
    distance[i] = r;
    along_x[i] = x * unit;
    along_y[i] = y * unit;
    if constexpr (D == 3) along_z[i] = (cz - pz[i]) * unit;
  }
  return column_extremes(rows.distances());
}

template class CenterFrame<2>;
template class CenterFrame<3>;

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
