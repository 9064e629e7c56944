#include "fit/least_squares/probe_tip.h"

#include <cmath>

#include <Eigen/Dense>

#include "fit/least_squares/sphere.h"

namespace rondure::fit {
namespace {

/// Variance of the radius for residuals of variance 1, from the gradients at the minimum.
double radius_variance(SpacePoints points, const Eigen::Vector3d& center) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
  for (const Eigen::Vector3d& p : points) {
    Eigen::Vector4d row;
    row << -(p - center).normalized(), -1.0;
    matrix += row * row.transpose();
  }
  return matrix.inverse()(3, 3);
}

}  // namespace

core::Result<ProbeTip> qualify_tip(SpacePoints tip_centers_mm, double sphere_radius_mm) {
  TRY_DO(check_points(tip_centers_mm));
  if (distinct_points(tip_centers_mm, 5) < 5) {
    return core::fail(
        core::Code::kTooFewPoints,
        "the qualification needs at least 5 different touches of the reference sphere");
  }
  const auto sphere = ls_sphere(tip_centers_mm);
  if (!sphere && sphere.error().code == core::Code::kRank) {
    return core::fail(core::Code::kRank,
                      "all touches of the reference sphere lie on one circle: touch its pole too");
  }
  if (!sphere) return core::fail(sphere.error());
  const auto n = static_cast<double>(tip_centers_mm.size());
  ProbeTip tip;
  tip.sphere_center_mm = sphere->center_mm;
  tip.radius_mm = sphere->radius_mm - sphere_radius_mm;
  tip.radius_per_touch = std::sqrt(radius_variance(tip_centers_mm, sphere->center_mm));
  tip.radius_sigma_mm = sphere->rms_mm * std::sqrt(n / (n - 4.0)) * tip.radius_per_touch;
  tip.form_mm = sphere->deviation_mm;
  return tip;
}

}  // namespace rondure::fit
