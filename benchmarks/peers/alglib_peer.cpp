#include "benchmarks/peers/alglib_peer.h"

#include <libalglib/interpolation.h>

namespace rondure::benchmarks {

double alglib_zone_width_mm(std::span<const Eigen::Vector2d> points_mm) {
  const auto count = static_cast<alglib::ae_int_t>(points_mm.size());
  alglib::real_2d_array points;
  points.setcontent(count, 2, points_mm.front().data());
  alglib::real_1d_array center;
  double inner = 0.0;
  double outer = 0.0;
  alglib::fitspheremz(points, count, 2, center, inner, outer);
  return outer - inner;
}

}  // namespace rondure::benchmarks
