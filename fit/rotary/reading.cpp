#include "fit/rotary/reading.h"

#include <algorithm>
#include <cmath>

namespace rondure::fit {

Matrix6 turn_covariance(const Eigen::Vector3d& direction, const Eigen::Vector3d& through_mm,
                        double u_rad) {
  Vector6 v;
  v << -direction.cross(through_mm), direction;
  return u_rad * u_rad * v * v.transpose();
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
