#include "fit/ls_circle.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include "fit/points.h"

namespace rondure::fit {
namespace {

// Below this share of (Suu + Svv)^2 the determinant is round-off and the points are on a line.
constexpr double kCollinearShare = 1e-12;
constexpr int kIterationLimit = 200;

/// Fills deviation and rms about the centre.
void fill_residuals(std::span<const Eigen::Vector2d> points_mm, LsCircle& circle) {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  double squares = 0.0;
  for (const Eigen::Vector2d& p : points_mm) {
    const double r = (p - circle.center_mm).norm();
    low = std::min(low, r);
    high = std::max(high, r);
    squares += (r - circle.radius_mm) * (r - circle.radius_mm);
  }
  circle.deviation_mm = high - low;
  circle.rms_mm = std::sqrt(squares / static_cast<double>(points_mm.size()));
}

struct NormalEquations {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0.0;
};

/// Gauss-Newton sums of the residuals |p - c| - R with points relative to `origin`.
NormalEquations normal_equations(std::span<const Eigen::Vector2d> points_mm,
                                 const Eigen::Vector2d& origin, const Eigen::Vector2d& center,
                                 double radius) {
  NormalEquations out;
  for (const Eigen::Vector2d& p : points_mm) {
    const Eigen::Vector2d v = (p - origin) - center;
    const double r = v.norm();
    if (r == 0.0) continue;  // the centre itself has no direction; it still cannot attract the fit
    const Eigen::Vector3d row(-v.x() / r, -v.y() / r, -1.0);
    const double residual = r - radius;
    out.matrix += row * row.transpose();
    out.right -= row * residual;
    out.squares += residual * residual;
  }
  return out;
}

}  // namespace

core::Result<LsCircle> algebraic_circle(std::span<const Eigen::Vector2d> points_mm) {
  if (auto checked = check_points(points_mm); !checked) return core::fail(checked.error());
  if (distinct_points(points_mm, 3) < 3) {
    return core::fail(core::Code::kTooFewPoints,
                      fmt::format("a circle needs at least 3 different points, there are {}",
                                  distinct_points(points_mm, 3)));
  }
  const Eigen::Vector2d mean = mean_point(points_mm);
  double suu = 0.0, suv = 0.0, svv = 0.0, a = 0.0, b = 0.0;
  for (const Eigen::Vector2d& p : points_mm) {
    const double u = p.x() - mean.x();
    const double v = p.y() - mean.y();
    suu += u * u;
    suv += u * v;
    svv += v * v;
    a += 0.5 * u * (u * u + v * v);
    b += 0.5 * v * (u * u + v * v);
  }
  const double determinant = suu * svv - suv * suv;
  if (determinant <= kCollinearShare * (suu + svv) * (suu + svv)) {
    return core::fail(core::Code::kCollinear,
                      "the points lie on one straight line, a circle through them has no centre");
  }
  const double uc = (a * svv - b * suv) / determinant;
  const double vc = (b * suu - a * suv) / determinant;
  LsCircle circle;
  circle.center_mm = mean + Eigen::Vector2d(uc, vc);
  circle.radius_mm =
      std::sqrt(uc * uc + vc * vc + (suu + svv) / static_cast<double>(points_mm.size()));
  fill_residuals(points_mm, circle);
  return circle;
}

core::Result<LsCircle> ls_circle(std::span<const Eigen::Vector2d> points_mm) {
  auto start = algebraic_circle(points_mm);
  if (!start) return start;
  const Eigen::Vector2d origin = mean_point(points_mm);
  Eigen::Vector2d center = start->center_mm - origin;
  double radius = start->radius_mm;
  NormalEquations now = normal_equations(points_mm, origin, center, radius);
  double damping = 0.0;
  for (int i = 0; i < kIterationLimit; ++i) {
    Eigen::Matrix3d damped = now.matrix;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::Vector3d step = damped.ldlt().solve(now.right);
    const auto next =
        normal_equations(points_mm, origin, center + step.head<2>(), radius + step(2));
    if (step.norm() <= 1e-15 * (radius + center.norm())) {
      LsCircle circle = *start;
      circle.center_mm = origin + center;
      circle.radius_mm = radius;
      fill_residuals(points_mm, circle);
      return circle;
    }
    // The last digits are round-off of the sum of squares: a tiny undamped step is always taken.
    if (next.squares <= now.squares || step.norm() <= 1e-9 * radius) {
      center += step.head<2>();
      radius += step(2);
      now = next;
      damping = damping > 1e-6 ? damping / 10.0 : 0.0;
      continue;
    }
    damping = std::max(1e-3, damping * 10.0);
  }
  // Steps that no longer shrink below 1e-15 but stay at the round-off of the sums are the minimum.
  const Eigen::Vector3d rest = now.matrix.ldlt().solve(now.right);
  if (rest.norm() > 1e-11 * (radius + center.norm())) {
    return core::fail(
        core::Code::kNotConverged,
        fmt::format("the least-squares circle still moves by {:.3g} mm after {} steps", rest.norm(),
                    kIterationLimit));
  }
  LsCircle circle;
  circle.center_mm = origin + center;
  circle.radius_mm = radius;
  fill_residuals(points_mm, circle);
  return circle;
}

}  // namespace rondure::fit
