#include "fit/probe_tip.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "fit/points.h"

namespace rondure::fit {
namespace {

/// Relative eigenvalue below which all touches lie on one circle and the height is undetermined.
constexpr double kRankShare = 1e-12;

struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// One Gauss-Newton step on |p - c| - R; gives the inverse normal matrix for the uncertainty.
Eigen::Matrix4d improve(std::span<const Eigen::Vector3d> points, Sphere& sphere) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d v = p - sphere.center;
    Eigen::Vector4d row;
    row << -v.normalized(), -1.0;
    matrix += row * row.transpose();
    right -= row * (v.norm() - sphere.radius);
  }
  const Eigen::Matrix4d inverse = matrix.inverse();
  const Eigen::Vector4d step = inverse * right;
  sphere.center += step.head<3>();
  sphere.radius += step(3);
  return inverse;
}

}  // namespace

core::Result<ProbeTip> qualify_tip(std::span<const Eigen::Vector3d> tip_centers_mm,
                                   double sphere_radius_mm) {
  if (auto checked = check_points(tip_centers_mm); !checked) return core::fail(checked.error());
  if (distinct_points(tip_centers_mm, 5) < 5) {
    return core::fail(
        core::Code::kTooFewPoints,
        "the qualification needs at least 5 different touches of the reference sphere");
  }
  const Eigen::Vector3d mean = mean_point(tip_centers_mm);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Vector3d cubes = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (const Eigen::Vector3d& p : tip_centers_mm) {
    const Eigen::Vector3d u = p - mean;
    scatter += 2.0 * u * u.transpose();
    cubes += u * u.squaredNorm();
    squares += u.squaredNorm();
  }
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  if (spread(0) <= kRankShare * spread(2)) {
    return core::fail(core::Code::kRank,
                      "all touches of the reference sphere lie on one circle: touch its pole too");
  }
  const auto n = static_cast<double>(tip_centers_mm.size());
  const Eigen::Vector3d shift = scatter.ldlt().solve(cubes);
  Sphere sphere{mean + shift, std::sqrt(shift.squaredNorm() + squares / n)};
  Eigen::Matrix4d inverse = Eigen::Matrix4d::Zero();
  for (int i = 0; i < 3; ++i) inverse = improve(tip_centers_mm, sphere);

  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double sum = 0.0;
  for (const Eigen::Vector3d& p : tip_centers_mm) {
    const double residual = (p - sphere.center).norm() - sphere.radius;
    low = std::min(low, residual);
    high = std::max(high, residual);
    sum += residual * residual;
  }
  ProbeTip tip;
  tip.sphere_center_mm = sphere.center;
  tip.radius_mm = sphere.radius - sphere_radius_mm;
  tip.radius_sigma_mm = std::sqrt(sum / (n - 4.0) * inverse(3, 3));
  tip.form_mm = high - low;
  return tip;
}

}  // namespace rondure::fit
