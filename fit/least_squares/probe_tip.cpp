#include "fit/least_squares/probe_tip.h"

#include <cmath>

#include <Eigen/Dense>

#include "core/decompositions.h"
#include "fit/least_squares/cylinder.h"
#include "fit/least_squares/sphere.h"

namespace rondure::fit {
namespace {

/// How the distance from the surface changes with its place, its lean and its radius: a row for
/// each touch, the radius last.
Eigen::MatrixXd gradients(SpacePoints points, const ProbeTip& tip) {
  const bool column = tip.on_column();
  Eigen::MatrixXd out(static_cast<Eigen::Index>(points.size()), column ? 5 : 4);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points[i] - tip.sphere_center_mm;
    auto row = out.row(static_cast<Eigen::Index>(i));
    if (column) {
      const Eigen::Vector2d n = (across(tip.column_axis).transpose() * p).normalized();
      row << n.transpose(), tip.column_axis.dot(p) * n.transpose(), 1.0;
    } else {
      row << p.normalized().transpose(), 1.0;
    }
  }
  return out;
}

/// Fills in the scatter of the radius that the residuals show.
void state_scatter(SpacePoints points, double rms_mm, ProbeTip& tip) {
  const Eigen::VectorXd weights = radius_weights(points, tip);
  const auto n = static_cast<double>(points.size());
  const double unknowns = tip.on_column() ? 5.0 : 4.0;
  tip.radius_per_touch = weights.norm();
  tip.radius_sigma_mm = rms_mm * std::sqrt(n / (n - unknowns)) * tip.radius_per_touch;
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
  ProbeTip tip;
  tip.sphere_center_mm = sphere->center_mm;
  tip.radius_mm = sphere->radius_mm - sphere_radius_mm;
  tip.form_mm = sphere->deviation_mm;
  state_scatter(tip_centers_mm, sphere->rms_mm, tip);
  return tip;
}

core::Result<ProbeTip> qualify_tip_on_column(SpacePoints tip_centers_mm, double column_radius_mm) {
  TRY_DO(check_points(tip_centers_mm));
  if (distinct_points(tip_centers_mm, 6) < 6) {
    return core::fail(
        core::Code::kTooFewPoints,
        "the qualification needs at least 6 different touches of the reference column");
  }
  const auto cylinder = ls_cylinder(tip_centers_mm, Eigen::Vector3d::UnitZ());
  if (!cylinder && cylinder.error().code == core::Code::kRank) {
    return core::fail(core::Code::kRank,
                      "all touches of the reference column lie at one height: touch it at two or "
                      "more");
  }
  if (!cylinder) return core::fail(cylinder.error());
  ProbeTip tip;
  tip.column_axis = cylinder->axis.direction;
  tip.sphere_center_mm = cylinder->axis.point_mm;
  tip.radius_mm = cylinder->radius_mm - column_radius_mm;
  tip.form_mm = cylinder->deviation_mm;
  state_scatter(tip_centers_mm, cylinder->rms_mm, tip);
  return tip;
}

Eigen::VectorXd radius_weights(SpacePoints tip_centers_mm, const ProbeTip& tip) {
  const Eigen::MatrixXd rows = gradients(tip_centers_mm, tip);
  const Eigen::MatrixXd normal = rows.transpose() * rows;
  const Eigen::VectorXd radius = Eigen::VectorXd::Unit(normal.cols(), normal.cols() - 1);
  return rows * core::solve_ldlt(normal, radius);
}

}  // namespace rondure::fit
