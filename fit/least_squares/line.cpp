#include "fit/least_squares/line.h"

#include <algorithm>
#include <cmath>

#include "core/decompositions.h"

namespace rondure::fit {
namespace {

/// Directions whose extents differ by less than this share of the larger one count as equal.
constexpr double kAlikeExtents = 1e-12;

Eigen::Matrix3d scatter_about(SpacePoints points, const Eigen::Vector3d& mean) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) out += (p - mean) * (p - mean).transpose();
  return out;
}

/// Turns a direction that is nearly the first principal axis onto it. The eigenvector is accurate
/// only to 1e-16 of the length of the line, which may be a metre; sums across the direction are
/// accurate to 1e-16 of the distances.
Eigen::Vector3d refined_direction(SpacePoints points, const Eigen::Vector3d& mean,
                                  const Eigen::Vector3d& direction) {
  const auto frame = across(direction);
  Eigen::Matrix2d side = Eigen::Matrix2d::Zero();
  Eigen::Vector2d mixed = Eigen::Vector2d::Zero();
  double along = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector2d q = frame.transpose() * (p - mean);
    const double s = direction.dot(p - mean);
    side += q * q.transpose();
    mixed += s * q;
    along += s * s;
  }
  // The gradient of the sum with respect to the tilt is -mixed, its second derivative along - side.
  const Eigen::Matrix2d curvature = along * Eigen::Matrix2d::Identity() - side;
  return (direction + frame * (curvature.inverse() * mixed)).normalized();
}

}  // namespace

core::Result<LsLine> ls_line(SpacePoints points_mm) {
  TRY_DO(check_points(points_mm));
  if (distinct_points(points_mm, 2) < 2) {
    return core::fail(core::Code::kTooFewPoints,
                      "a line needs at least 2 different points, all points are one");
  }
  const Eigen::Vector3d mean = mean_point(points_mm);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(scatter_about(points_mm, mean));
  const Eigen::Vector3d spread = principal.eigenvalues();
  if (spread(2) - spread(1) <= kAlikeExtents * spread(2)) {
    return core::fail(core::Code::kRank,
                      "the points extend as far in two directions: no line fits them best");
  }
  const Eigen::Vector3d direction =
      refined_direction(points_mm, mean, principal.eigenvectors().col(2));
  LsLine out;
  out.axis = conventional({mean, direction}, mean);
  const auto frame = across(direction);
  double squares = 0.0;
  double farthest = 0.0;
  for (const Eigen::Vector3d& p : points_mm) {
    const double square = (frame.transpose() * (p - mean)).squaredNorm();
    squares += square;
    farthest = std::max(farthest, square);
  }
  out.deviation_mm = 2.0 * std::sqrt(farthest);
  out.rms_mm = std::sqrt(squares / static_cast<double>(points_mm.size()));
  return out;
}

core::Result<LsLine> median_line_straightness(SpacePoints section_centers_mm) {
  if (section_centers_mm.size() < 3) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "{} section centres; the straightness of a median line needs at least "
                           "3, two are always on a line",
                           section_centers_mm.size());
  }
  return ls_line(section_centers_mm);
}

}  // namespace rondure::fit
