#include "fit/geometry/center_frame.h"

#include <cmath>

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

}  // namespace rondure::fit
