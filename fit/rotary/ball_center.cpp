#include "fit/rotary/ball_center.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/sphere.h"

namespace rondure::fit {

core::Result<BallCenter> ball_center(SpacePoints points_mm, double radius_mm) {
  if (!std::isfinite(radius_mm) || radius_mm <= 0.0) {
    return core::fail_with(core::Code::kBadOption, "a ball of radius {:g} mm has no surface",
                           radius_mm);
  }
  TRY(const auto start, ls_sphere(points_mm));
  constexpr int kSteps = 50;
  const double still_mm = 1e-12 * std::max(1.0, start.radius_mm);
  BallCenter out;
  out.center_mm = start.center_mm;
  for (int i = 0; i < kSteps; ++i) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    Eigen::Vector3d outward = Eigen::Vector3d::Zero();
    Extremes range;
    out.sum_squares_mm2 = out.sum_mm = 0.0;
    for (const Eigen::Vector3d& p : points_mm) {
      const Eigen::Vector3d v = p - out.center_mm;
      const double distance = v.norm();
      const Eigen::Vector3d n = v / distance;
      const double residual = distance - radius_mm;
      normal += n * n.transpose();
      right += residual * n;
      outward += n;
      out.sum_mm += residual;
      out.sum_squares_mm2 += residual * residual;
      range.take(residual);
    }
    out.cofactor = normal.inverse();
    out.per_radius = -out.cofactor * outward;
    out.sum_per_radius = -static_cast<double>(points_mm.size()) - outward.dot(out.per_radius);
    out.deviation_mm = range.width();
    const Eigen::Vector3d step = out.cofactor * right;
    if (!step.allFinite()) break;
    out.center_mm += step;
    if (step.norm() <= still_mm) return out;
  }
  return core::fail_with(core::Code::kNotConverged,
                         "no centre of a ball of {:g} mm radius was found", radius_mm);
}

}  // namespace rondure::fit
