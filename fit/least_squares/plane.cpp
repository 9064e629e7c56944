#include "fit/least_squares/plane.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "core/decompositions.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

/// Least spread across the longest direction of the points, as a share of that along it: form and
/// noise turn a plane through a line about that line, up to its edge.
constexpr double kLeastSpread = 0.01;

/// Moves the normal by a step of Newton's method. The eigenvector has errors of 1e-16 in direction,
/// and those times the size of the plane would be errors of the heights.
Eigen::Vector3d refined_normal(SpacePoints points, const Eigen::Vector3d& mean,
                               const Eigen::Vector3d& normal) {
  const auto frame = across(normal);
  Eigen::Matrix2d side = Eigen::Matrix2d::Zero();
  Eigen::Vector2d mixed = Eigen::Vector2d::Zero();
  double squares = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d q = frame.transpose() * (p - mean);
    const double h = normal.dot(p - mean);
    side += q * q.transpose();
    mixed += h * q;
    squares += h * h;
  }
  const Eigen::Matrix2d curvature = side - squares * Eigen::Matrix2d::Identity();
  return (normal - frame * (curvature.inverse() * mixed)).normalized();
}

Eigen::Vector3d turned_outward(const Eigen::Vector3d& normal,
                               const std::optional<Eigen::Vector3d>& outward) {
  if (outward) return normal.dot(*outward) < 0.0 ? Eigen::Vector3d(-normal) : normal;
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  return normal(largest) < 0.0 ? Eigen::Vector3d(-normal) : normal;
}

}  // namespace

core::Result<LsPlane> ls_plane(SpacePoints points_mm,
                               const std::optional<Eigen::Vector3d>& outward) {
  TRY_DO(check_points(points_mm));
  if (distinct_points(points_mm, 3) < 3) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "a plane needs at least 3 different points, there are {}",
                           distinct_points(points_mm, 3));
  }
  const Eigen::Vector3d mean = mean_point(points_mm);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points_mm) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(scatter);
  const Eigen::Vector3d spread = principal.eigenvalues();
  if (spread(1) <= kLeastSpread * kLeastSpread * spread(2)) {
    return core::fail_with(core::Code::kCollinear,
                           "the points lie along one line, and a plane through them can turn about "
                           "it: across the line they spread by {:.2f} % of their length, {:g} % "
                           "is needed; touch points all over the face",
                           100.0 * std::sqrt(std::max(0.0, spread(1)) / spread(2)),
                           100.0 * kLeastSpread);
  }
  if (spread(1) - spread(0) <= 1e-9 * spread(1)) {
    return core::fail(core::Code::kRank,
                      "the points extend no less in one direction than in the others: no plane "
                      "fits them best");
  }
  LsPlane out;
  out.plane.point_mm = mean;
  out.plane.normal =
      turned_outward(refined_normal(points_mm, mean, principal.eigenvectors().col(0)), outward);
  double squares = 0.0;
  Extremes heights;
  for (const Eigen::Vector3d& p : points_mm) {
    const double h = height_mm(out.plane, p);
    heights.take(h);
    squares += h * h;
  }
  out.deviation_mm = heights.width();
  out.rms_mm = std::sqrt(squares / static_cast<double>(points_mm.size()));
  return out;
}

}  // namespace rondure::fit
