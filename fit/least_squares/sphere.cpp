#include "fit/least_squares/sphere.h"

#include <cmath>

#include "core/decompositions.h"
#include "fit/least_squares/internal/gauss_newton.h"
#include "fit/least_squares/internal/sums.h"

namespace rondure::fit {
namespace {

/// Relative eigenvalue below which all points lie in one plane and the height is undetermined.
constexpr double kRankShare = 1e-12;

/// The sphere during the iteration, relative to an origin amid the points.
struct SphereModel {
  static constexpr int kUnknowns = 4;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;

  [[nodiscard]] SphereModel moved(const Eigen::Vector4d& step) const {
    return {center + step.head<3>(), radius + step(3)};
  }
  [[nodiscard]] double scale_mm() const { return std::abs(radius) + center.norm(); }
};

/// Minimises the sum of (|p - c|^2 - R^2)^2; the points are relative to `origin`, their mean.
core::Result<SphereModel> algebraic_sphere(SpacePoints points, const Eigen::Vector3d& origin) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Vector3d cubes = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d u = p - origin;
    scatter += u * u.transpose();
    cubes += 0.5 * u.squaredNorm() * u;
  }
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  if (spread(0) <= kRankShare * spread(2)) {
    return core::fail(core::Code::kRank,
                      "all points lie in one plane: the height of a sphere's centre above it is "
                      "undetermined (fit circle)");
  }
  const Eigen::Vector3d center = core::solve_ldlt(scatter, cubes);
  return SphereModel{center, std::sqrt(center.squaredNorm() +
                                       scatter.trace() / static_cast<double>(points.size()))};
}

NormalSums<4> sphere_sums(SpacePoints points, const Eigen::Vector3d& origin,
                          const SphereModel& at) {
  NormalSums<4> out;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d v = (p - origin) - at.center;
    const double r = v.norm();
    if (r == 0.0) continue;  // a point at the centre has no gradient and adds nothing to the step
    Eigen::Vector4d row;
    row << -v / r, -1.0;
    const double residual = r - at.radius;
    out.matrix += row * row.transpose();
    out.right -= row * residual;
    out.squares += residual * residual;
  }
  return out;
}

}  // namespace

core::Result<LsSphere> ls_sphere(SpacePoints points_mm) {
  TRY_DO(check_points(points_mm));
  if (distinct_points(points_mm, 4) < 4) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "a sphere needs at least 4 different points, there are {}",
                           distinct_points(points_mm, 4));
  }
  const Eigen::Vector3d origin = mean_point(points_mm);
  TRY(auto model, algebraic_sphere(points_mm, origin));
  double squares = 0.0;
  const auto sums_at = [&](const SphereModel& at, bool) {
    return sphere_sums(points_mm, origin, at);
  };
  if (!settle(model, squares, sums_at)) {
    return core::fail(core::Code::kNotConverged, "the least-squares sphere did not settle");
  }
  const auto range = distance_range(points_mm.size(), [&](std::size_t i) {
    return ((points_mm[i] - origin) - model.center).norm();
  });
  return LsSphere{origin + model.center, model.radius, range.width(),
                  std::sqrt(squares / static_cast<double>(points_mm.size()))};
}

}  // namespace rondure::fit
