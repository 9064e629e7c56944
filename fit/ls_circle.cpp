#include "fit/ls_circle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "fit/gauss_newton.h"
#include "fit/ls_sums.h"
#include "fit/points.h"

namespace rondure::fit {
namespace {

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

/// Circle under iteration, relative to an origin amid the points.
struct CircleModel {
  static constexpr int kUnknowns = 3;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double radius = 0.0;

  [[nodiscard]] CircleModel moved(const Eigen::Vector3d& step) const {
    return {center + step.head<2>(), radius + step(2)};
  }
  [[nodiscard]] double scale_mm() const { return radius + center.norm(); }
};

LsCircle finished(const CircleModel& model, const Eigen::Vector2d& origin, double squares,
                  const DistanceRange& range, std::size_t n) {
  LsCircle out;
  out.center_mm = origin + model.center;
  out.radius_mm = model.radius;
  out.deviation_mm = range.high_mm - range.low_mm;
  out.rms_mm = std::sqrt(squares / static_cast<double>(n));
  return out;
}

/// A large set from the circle of a sample; nothing when that does not lead to the minimum.
std::optional<LsCircle> from_sample(std::span<const Eigen::Vector2d> points_mm) {
  std::array<Eigen::Vector2d, kStartSample> sample;
  sample_points(points_mm, sample);
  const auto start = ls_circle(sample);
  if (!start) return std::nullopt;
  const Eigen::Vector2d origin = mean_point(sample);
  CircleModel model{start->center_mm - origin, start->radius_mm};
  StretchExtremes extremes(points_mm.size());
  const auto sums_at = [&](const CircleModel& at, bool matrix) {
    extremes = StretchExtremes(points_mm.size());
    return circle_sums(points_mm, origin, at.center, at.radius, {matrix, &extremes});
  };
  double squares = 0.0;
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  if (!polish(model, squares, sums_at, step)) return std::nullopt;
  const auto range = distance_range(
      points_mm.size(),
      [&](std::size_t i) { return ((points_mm[i] - origin) - model.center).norm(); }, &extremes,
      step.cwiseAbs().sum() + 1e-13 * model.scale_mm());
  return finished(model, origin, squares, range, points_mm.size());
}

}  // namespace

core::Result<LsCircle> algebraic_start(std::span<const Eigen::Vector2d> points_mm) {
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
  return circle;
}

core::Result<LsCircle> algebraic_circle(std::span<const Eigen::Vector2d> points_mm) {
  auto circle = algebraic_start(points_mm);
  if (circle) fill_residuals(points_mm, *circle);
  return circle;
}

core::Result<LsCircle> ls_circle(std::span<const Eigen::Vector2d> points_mm) {
  if (points_mm.size() > kStartSample) {
    if (const auto circle = from_sample(points_mm)) return *circle;
  }
  const auto start = algebraic_start(points_mm);
  if (!start) return start;
  const Eigen::Vector2d origin = mean_point(points_mm);
  CircleModel model{start->center_mm - origin, start->radius_mm};
  const auto sums_at = [&](const CircleModel& at, bool matrix) {
    return circle_sums(points_mm, origin, at.center, at.radius, {matrix});
  };
  double squares = 0.0;
  if (!settle(model, squares, sums_at)) {
    return core::fail(core::Code::kNotConverged, "the least-squares circle did not settle");
  }
  const auto range = distance_range(points_mm.size(), [&](std::size_t i) {
    return ((points_mm[i] - origin) - model.center).norm();
  });
  return finished(model, origin, squares, range, points_mm.size());
}

}  // namespace rondure::fit
