#include "fit/least_squares/circle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fit/least_squares/internal/gauss_newton.h"
#include "fit/least_squares/internal/sums.h"

namespace rondure::fit {
namespace {

/// Curvature times length below which points are on a line: radius and centre are round-off.
constexpr double kStraight = 1e-9;
/// An arc is flat if its radius is at least this many times its length.
constexpr double kFlat = 3.0;

/// Fills deviation and rms about the centre.
void fill_residuals(PlanePoints points_mm, LsCircle& circle) {
  Extremes range;
  double squares = 0.0;
  for (const Eigen::Vector2d& p : points_mm) {
    const double r = (p - circle.center_mm).norm();
    range.take(r);
    squares += (r - circle.radius_mm) * (r - circle.radius_mm);
  }
  circle.deviation_mm = range.width();
  circle.rms_mm = std::sqrt(squares / static_cast<double>(points_mm.size()));
}

/// The circle during the iteration, relative to an origin amid the points.
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
                  const Extremes& range, std::size_t n) {
  LsCircle out;
  out.center_mm = origin + model.center;
  out.radius_mm = model.radius;
  out.deviation_mm = range.width();
  out.rms_mm = std::sqrt(squares / static_cast<double>(n));
  return out;
}

/// A circle as  A (x^2 + y^2) + B x + C y + D = 0  with B^2 + C^2 - 4 A D = 1; B and C follow from
/// an angle. A flat arc has a small A, whereas in centre and radius its minimum lies in an endless
/// valley. All three unknowns are in mm: A times the square of the length, D, the angle times the
/// length.
struct FlatCircle {
  static constexpr int kUnknowns = 3;
  double length = 1.0;  ///< Extent of the points from their mean.
  double curvature = 0.0;
  double offset = 0.0;
  double angle = 0.0;

  [[nodiscard]] FlatCircle moved(const Eigen::Vector3d& step) const {
    return {length, curvature + step(0) / (length * length), offset + step(1),
            angle + step(2) / length};
  }
  [[nodiscard]] double scale_mm() const { return length; }
  /// |(B, C)|; not a number where the unknowns describe no circle.
  [[nodiscard]] double tilt() const { return std::sqrt(1.0 + 4.0 * curvature * offset); }
  [[nodiscard]] CircleModel circle() const {
    const double half = -0.5 * tilt() / curvature;
    return {half * Eigen::Vector2d(std::cos(angle), std::sin(angle)), 0.5 / std::abs(curvature)};
  }
};

FlatCircle flattened(const CircleModel& circle, double length) {
  FlatCircle out;
  out.length = length;
  out.curvature = 0.5 / circle.radius;
  out.angle = std::atan2(-circle.center.y(), -circle.center.x());
  out.offset = (circle.center.norm() - circle.radius) * (circle.center.norm() + circle.radius) *
               out.curvature;
  return out;
}

/// Sums of the distances and their gradients in the unknowns of a FlatCircle.
NormalSums<3> flat_sums(PlanePoints points_mm, const Eigen::Vector2d& origin,
                        const FlatCircle& at) {
  NormalSums<3> out;
  const Eigen::Vector2d toward(std::cos(at.angle), std::sin(at.angle));
  const Eigen::Vector2d aside(-toward.y(), toward.x());
  const double tilt = at.tilt();
  for (const Eigen::Vector2d& p : points_mm) {
    const Eigen::Vector2d v = p - origin;
    const double along = v.dot(toward);
    const double value = at.curvature * v.squaredNorm() + tilt * along + at.offset;
    const double root = std::sqrt(std::max(0.0, 1.0 + 4.0 * at.curvature * value));
    const double d = 2.0 * value / (1.0 + root);  // without the cancellation of |p - c| - R
    const double back = 1.0 / std::max(root, 1e-12);
    const Eigen::Vector3d gradient =
        back *
        Eigen::Vector3d(
            (v.squaredNorm() + 2.0 * at.offset / tilt * along - d * d) / (at.length * at.length),
            1.0 + 2.0 * at.curvature / tilt * along, tilt * v.dot(aside) / at.length);
    out.matrix += gradient * gradient.transpose();
    out.right -= d * gradient;
    out.squares += d * d;
  }
  return out;
}

/// Whether the points are a flat arc of a circle, with a distant centre and correlated radius.
bool is_flat(PlanePoints points_mm, const Eigen::Vector2d& origin, double radius) {
  return std::ranges::none_of(
      points_mm, [&](const Eigen::Vector2d& p) { return kFlat * (p - origin).norm() > radius; });
}

/// Finds the minimum in the unknowns of FlatCircle, for points whose centre is too far away.
bool settle_flat(PlanePoints points_mm, const Eigen::Vector2d& origin, CircleModel& model,
                 double& squares) {
  double length = 0.0;
  for (const Eigen::Vector2d& p : points_mm) length = std::max(length, (p - origin).norm());
  FlatCircle flat = flattened(model, length);
  const auto sums_at = [&](const FlatCircle& at, bool /*matrix*/) {
    return flat_sums(points_mm, origin, at);
  };
  if (!settle(flat, squares, sums_at) || !(std::abs(flat.curvature) * length > kStraight)) {
    return false;
  }
  model = flat.circle();
  return true;
}

/// Fits a large set from the circle of a sample; returns nothing if that does not converge.
std::optional<LsCircle> from_sample(PlanePoints points_mm) {
  std::array<Eigen::Vector2d, kStartSample> sample;
  sample_points(points_mm, sample);
  const auto start = ls_circle(sample);
  if (!start) return std::nullopt;
  const Eigen::Vector2d origin = mean_point(sample);
  if (is_flat(sample, origin, start->radius_mm)) return std::nullopt;
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

core::Result<LsCircle> algebraic_start(PlanePoints points_mm) {
  TRY_DO(check_points(points_mm));
  if (distinct_points(points_mm, 3) < 3) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "a circle needs at least 3 different points, there are {}",
                           distinct_points(points_mm, 3));
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

core::Result<LsCircle> algebraic_circle(PlanePoints points_mm) {
  auto circle = algebraic_start(points_mm);
  if (circle) fill_residuals(points_mm, *circle);
  return circle;
}

core::Result<LsCircle> ls_circle(PlanePoints points_mm) {
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
  const CircleModel first = model;
  bool settled = settle(model, squares, sums_at);
  // In the valley of a flat arc, steps become short relative to the radius long before the minimum.
  if (!settled || is_flat(points_mm, origin, model.radius)) {
    CircleModel flat = settled ? model : first;
    double least = 0.0;
    if (settle_flat(points_mm, origin, flat, least) && (!settled || least <= squares)) {
      model = flat;
      squares = least;
      settled = true;
    }
  }
  if (!settled) {
    return core::fail(core::Code::kNotConverged, "the least-squares circle did not settle");
  }
  const auto range = distance_range(points_mm.size(), [&](std::size_t i) {
    return ((points_mm[i] - origin) - model.center).norm();
  });
  return finished(model, origin, squares, range, points_mm.size());
}

}  // namespace rondure::fit
