#include "fit/center_frame.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rondure::fit {

template <int D>
ContactRow<D> CenterFrame<D>::contact_row(const Point& p, std::size_t index) const {
  const Point v = p - center_;
  const double r = v.norm();
  ContactRow<D> out{index, r, Point::Zero(), Eigen::Matrix<double, D, D>::Zero()};
  if (r == 0.0) return out;  // at the centre every direction is alike
  const Point n = v / r;
  out.gradient = -n;
  out.hessian = (Eigen::Matrix<double, D, D>::Identity() - n * n.transpose()) / r;
  return out;
}

template <int D>
Extremes CenterFrame<D>::linearise(const WorkingPoints<D>& points, ZoneRows<D>& rows) const {
  const std::size_t count = points.size();
  rows.resize(count);
  double* distance = rows.distances().data();
  std::array<double*, D> gradients;
  for (std::size_t i = 0; i < count; ++i) distance[i] = 0.0;
  for (std::size_t k = 0; k < D; ++k) {
    const double* p = points.column(static_cast<int>(k));
    double* gradient = gradients[k] = rows.gradients(static_cast<int>(k)).data();
    const double c = center_(static_cast<Eigen::Index>(k));
    for (std::size_t i = 0; i < count; ++i) {
      gradient[i] = c - p[i];
      distance[i] += gradient[i] * gradient[i];
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    distance[i] = std::sqrt(distance[i]);
    // At the centre every direction is alike.
    const double unit = distance[i] > 0.0 ? 1.0 / distance[i] : 0.0;
    for (std::size_t k = 0; k < D; ++k) gradients[k][i] *= unit;
  }
  const auto [low, high] = std::minmax_element(distance, distance + count);
  return {*low, *high};
}

template class CenterFrame<2>;
template class CenterFrame<3>;

}  // namespace rondure::fit
