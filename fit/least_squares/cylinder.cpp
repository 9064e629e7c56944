#include "fit/least_squares/cylinder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/decompositions.h"
#include "core/units.h"
#include "fit/geometry/frames.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/internal/gauss_newton.h"
#include "fit/least_squares/internal/start_directions.h"
#include "fit/least_squares/internal/sums.h"

namespace rondure::fit {
namespace {

// Squared extents below this share of the largest (3e-8 in length) are round-off of the sums.
constexpr double kFlat = 1e-15;

using Vector5 = Eigen::Matrix<double, 5, 1>;
/// The cylinder during the iteration, relative to an origin amid the points.
struct CylinderModel {
  static constexpr int kUnknowns = 5;
  CylinderFrame frame;
  double radius = 0.0;

  [[nodiscard]] CylinderModel moved(const Vector5& step) const {
    return {frame.moved(step.head<4>()), radius + step(4)};
  }
  [[nodiscard]] double scale_mm() const { return std::abs(radius) + frame.half_length_mm(); }
};

struct Settled {
  CylinderModel model;
  double squares = 0.0;
};

/// Starts from the algebraic circle of the projection along a direction. The points are relative to
/// `origin`, their mean.
core::Result<CylinderModel> start(SpacePoints points, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  const auto frame = across(direction);
  // Plain numbers, because sums in Eigen matrices would pass through memory at every point.
  double uu = 0.0, uv = 0.0, vv = 0.0, uc = 0.0, vc = 0.0;
  Extremes heights;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d at = p - origin;
    const double u = frame.col(0).dot(at), v = frame.col(1).dot(at), s = direction.dot(at);
    const double square = u * u + v * v;
    uu += u * u;
    uv += u * v;
    vv += v * v;
    uc += u * square;
    vc += v * square;
    heights.take(s);
  }
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > kCollinearShare * (uu + vv) * (uu + vv))) {
    return core::fail(core::Code::kCollinear,
                      "seen along the start direction the points lie on one straight line");
  }
  const Eigen::Vector2d center(0.5 * (uc * vv - vc * uv) / determinant,
                               0.5 * (vc * uu - uc * uv) / determinant);
  const double radius =
      std::sqrt(center.squaredNorm() + (uu + vv) / static_cast<double>(points.size()));
  const double half = 0.5 * heights.width();
  return CylinderModel{CylinderFrame({frame * center, direction}, half > 0.0 ? half : radius),
                       radius};
}

LsCylinder finished(const Settled& settled, const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& mean, const Extremes& range, std::size_t n) {
  LsCylinder out;
  Axis axis = settled.model.frame.axis();
  axis.point_mm += origin;
  out.axis = conventional(axis, mean);
  out.radius_mm = settled.model.radius;
  out.deviation_mm = range.width();
  out.rms_mm = std::sqrt(settled.squares / static_cast<double>(n));
  return out;
}

/// Refuses points on one line or in one plane. They are relative to `origin`, their mean.
core::Result<void> check_rank(SpacePoints points, const Eigen::Vector3d& origin) {
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  for (const Eigen::Vector3d& p : points) {
    const double x = p.x() - origin.x(), y = p.y() - origin.y(), z = p.z() - origin.z();
    xx += x * x;
    xy += x * y;
    xz += x * z;
    yy += y * y;
    yz += y * z;
    zz += z * z;
  }
  Eigen::Matrix3d scatter;
  scatter << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  // The least share of the extents is no less than the share given by the determinant, so the
  // eigenvalues are needed only where that is small.
  if (scatter.determinant() > 1e-9 * std::pow(scatter.trace(), 3)) return {};
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  if (spread(1) <= kFlat * spread(2)) {
    return core::fail(core::Code::kCollinear, "the points lie on one straight line");
  }
  if (spread(0) <= kFlat * spread(2)) {
    return core::fail(core::Code::kRank,
                      "all points lie in one plane: the tilt of a cylinder is undetermined, only "
                      "roundness can be given (fit circle)");
  }
  return {};
}

/// Start directions by the algebraic circle of the projected points, whose mean is `origin`.
std::vector<Eigen::Vector3d> directions(SpacePoints points, const Eigen::Vector3d& origin) {
  std::vector<Eigen::Vector3d> seen(std::min(points.size(), kStartSample));
  sample_points(points, seen);
  for (Eigen::Vector3d& p : seen) p -= origin;
  std::vector<Eigen::Vector2d> flat;
  return start_directions(
      seen, [&](SpacePoints sample, const Eigen::Vector3d& direction) -> std::optional<double> {
        const auto frame = across(direction);
        flat.clear();
        for (const Eigen::Vector3d& p : sample) flat.emplace_back(frame.transpose() * p);
        const auto circle = algebraic_circle(flat);
        if (!circle) return std::nullopt;
        return circle->rms_mm;
      });
}

core::Result<Settled> settle_from(SpacePoints points, const Eigen::Vector3d& origin,
                                  const Eigen::Vector3d& direction) {
  TRY(auto model, start(points, origin, direction));
  Settled out{model, 0.0};
  const auto sums_at = [&](const CylinderModel& at, bool matrix) {
    return cylinder_sums(points, origin, at.frame, at.radius, {matrix});
  };
  if (settle(out.model, out.squares, sums_at)) return out;
  return core::fail(core::Code::kNotConverged, "the least-squares cylinder did not settle");
}

/// The best cylinder over the starts, of points whose mean is `origin`.
core::Result<Settled> settle_all(SpacePoints points, const Eigen::Vector3d& origin,
                                 const std::optional<Eigen::Vector3d>& near_direction) {
  TRY_DO(check_rank(points, origin));
  if (near_direction) return settle_from(points, origin, near_direction->normalized());
  core::Result<Settled> best =
      core::fail(core::Code::kNotConverged, "the least-squares cylinder did not settle");
  for (const Eigen::Vector3d& direction : directions(points, origin)) {
    auto settled = settle_from(points, origin, direction);
    if (!best || (settled && settled->squares < best->squares)) best = std::move(settled);
  }
  return best;
}

/// Fits a large set from the cylinder of a sample; returns nothing if that does not converge.
std::optional<LsCylinder> from_sample(SpacePoints points_mm,
                                      const std::optional<Eigen::Vector3d>& near_direction) {
  std::array<Eigen::Vector3d, kStartSample> sample;
  sample_points(points_mm, sample);
  if (!check_points(sample) || distinct_points(sample, 5) < 5) return std::nullopt;
  const Eigen::Vector3d origin = mean_point(sample);
  auto settled = settle_all(sample, origin, near_direction);
  if (!settled) return std::nullopt;
  StretchExtremes extremes(points_mm.size());
  double lever = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  // relative to the origin
  const auto sums_at = [&](const CylinderModel& at, bool matrix) {
    extremes = StretchExtremes(points_mm.size());
    const auto sums = cylinder_sums(points_mm, origin, at.frame, at.radius, {matrix, &extremes});
    lever = std::max(lever, sums.lever);
    const Axis& axis = at.frame.axis();
    if (matrix) mean = axis.point_mm + at.frame.across_axis() * sums.across_mm;
    mean += axis.direction * (sums.along_mm - axis.direction.dot(mean));
    return sums;
  };
  Vector5 step = Vector5::Zero();
  if (!polish(settled->model, settled->squares, sums_at, step)) return std::nullopt;
  const CylinderFrame& frame = settled->model.frame;
  const double change =
      step.head<2>().cwiseAbs().sum() + lever * step.segment<2>(2).cwiseAbs().sum();
  const auto range = distance_range(
      points_mm.size(), [&](std::size_t i) { return frame.distance(points_mm[i] - origin); },
      &extremes, change + 1e-13 * settled->model.scale_mm());
  // conventional() uses only the position of the mean along the axis.
  return finished(*settled, origin, origin + mean, range, points_mm.size());
}

}  // namespace

core::Result<LsCylinder> ls_cylinder(SpacePoints points_mm,
                                     const std::optional<Eigen::Vector3d>& near_direction) {
  if (points_mm.size() > kStartSample) {
    if (const auto cylinder = from_sample(points_mm, near_direction)) return *cylinder;
  }
  TRY_DO(check_points(points_mm));
  if (distinct_points(points_mm, 5) < 5) {
    return core::fail_with(core::Code::kTooFewPoints,
                           "a cylinder needs at least 5 different points, there are {}",
                           distinct_points(points_mm, 5));
  }
  const Eigen::Vector3d mean = mean_point(points_mm);
  TRY(const auto settled, settle_all(points_mm, mean, near_direction));
  const CylinderFrame& frame = settled.model.frame;
  const auto range = distance_range(
      points_mm.size(), [&](std::size_t i) { return frame.distance(points_mm[i] - mean); });
  return finished(settled, mean, mean, range, points_mm.size());
}

core::Result<void> check_only_cylinder(SpacePoints points_mm, const LsCylinder& found) {
  constexpr std::size_t kFew = 64;
  constexpr double kNear = 0.005;
  if (points_mm.size() > kFew) return {};
  const auto said = [](const LsCylinder& c) {
    const Eigen::Vector3d& d = c.axis.direction;
    return fmt::format("one along ({:.2f}, {:.2f}, {:.2f}) of diameter {:.4f} mm within {:.3f} um",
                       d.x(), d.y(), d.z(), 2.0 * c.radius_mm, core::micrometres(c.deviation_mm));
  };
  // Directions through the places of a cube of 5 x 5 x 5; of two opposite ones, one.
  for (int code = 63; code < 125; ++code) {
    const Eigen::Vector3d direction(code / 25 - 2, code / 5 % 5 - 2, code % 5 - 2);
    const auto other = ls_cylinder(points_mm, direction);
    if (!other || other->deviation_mm > kNear * other->radius_mm) continue;
    const double lean = other->axis.direction.cross(found.axis.direction).norm();
    if (lean <= std::sin(10.0 * core::kDegree)) continue;
    return core::fail_with(core::Code::kSeveralOptima,
                           "more than one cylinder passes through the {} points: {}, and {}; give "
                           "the file a column layer, or more points",
                           points_mm.size(), said(found), said(*other));
  }
  return {};
}

}  // namespace rondure::fit
