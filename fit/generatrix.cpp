#include "fit/generatrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "fit/points.h"
#include "fit/zone_program.h"

namespace rondure::fit {
namespace {

constexpr int kTurnLimit = 50;

/// Least-squares line r = mean + slope (z - mean z); nothing where all z are alike.
std::optional<double> ls_slope(std::span<const Eigen::Vector2d> points,
                               const Eigen::Vector2d& mean) {
  double zz = 0.0;
  double zr = 0.0;
  double size = 0.0;
  for (const Eigen::Vector2d& p : points) {
    zz += (p.x() - mean.x()) * (p.x() - mean.x());
    zr += (p.x() - mean.x()) * (p.y() - mean.y());
    size = std::max(size, std::abs(p.x()));
  }
  const double round_off = 16.0 * std::numeric_limits<double>::epsilon() * size;
  if (zz <= static_cast<double>(points.size()) * round_off * round_off) return std::nullopt;
  return zr / zz;
}

/// The points about `mean` in a frame whose first axis has the given slope.
std::vector<Eigen::Vector2d> turned(std::span<const Eigen::Vector2d> points,
                                    const Eigen::Vector2d& mean, double slope) {
  const double scale = 1.0 / std::hypot(1.0, slope);
  std::vector<Eigen::Vector2d> out;
  out.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d v = p - mean;
    out.emplace_back((v.x() + slope * v.y()) * scale, (v.y() - slope * v.x()) * scale);
  }
  return out;
}

/// Least zone across the first axis, over the slope: repeated until the slope no longer changes.
core::Result<double> least_zone(std::span<const Eigen::Vector2d> points,
                                const Eigen::Vector2d& mean, double slope) {
  for (int turn = 0; turn < kTurnLimit; ++turn) {
    const auto frame = turned(points, mean, slope);
    double half = 0.0;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const Eigen::Vector2d& p : frame) {
      half = std::max(half, std::abs(p.x()));
      low = std::min(low, p.y());
      high = std::max(high, p.y());
    }
    ZoneRows<1> rows;
    for (const Eigen::Vector2d& p : frame) {
      rows.push_back(p.y(), Eigen::Matrix<double, 1, 1>(-p.x() / half));
    }
    const double zone = high - low;
    const auto step = solve_zone_program<1>(rows, 2.0 * zone);
    const double gain = zone - step.value;
    if (step.solved && gain <= 1e-13 * zone + 1e-15) return zone;
    const double change = step.step(0) / half;
    slope = (slope + change) / (1.0 - slope * change);
  }
  return core::fail(
      core::Code::kNotConverged,
      fmt::format("the zone of the generatrix still shrinks after {} turns", kTurnLimit));
}

core::Error no_length() {
  return {core::Code::kRank,
          "all points stand at one position along the axis; straightness and "
          "taper need at least two sections",
          {}};
}

}  // namespace

core::Result<GeneratrixStraightness> generatrix_straightness(std::span<const double> z_mm,
                                                             std::span<const double> r_mm) {
  if (z_mm.size() != r_mm.size()) {
    return core::fail(core::Code::kNoPoints,
                      fmt::format("{} positions and {} radii; as many of both are needed",
                                  z_mm.size(), r_mm.size()));
  }
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < z_mm.size(); ++i) points.emplace_back(z_mm[i], r_mm[i]);
  if (auto checked = check_points(points); !checked) return core::fail(checked.error());
  if (points.size() < 3) {
    return core::fail(
        core::Code::kTooFewPoints,
        fmt::format("{} points on a generatrix; straightness needs at least 3", points.size()));
  }
  const Eigen::Vector2d mean = mean_point(points);
  const auto slope = ls_slope(points, mean);
  if (!slope) return core::fail(no_length());
  GeneratrixStraightness out;
  out.ls_slope = *slope;
  std::vector<double> deviations;
  for (const Eigen::Vector2d& p : turned(points, mean, *slope)) deviations.push_back(p.y());
  out.ls = form_parameters(deviations);
  const auto zone = least_zone(points, mean, *slope);
  if (!zone) return core::fail(zone.error());
  out.zone_mm = *zone;
  return out;
}

core::Result<Taper> taper(std::span<const Eigen::Vector3d> points_mm, const Axis& axis) {
  if (auto checked = check_points(points_mm); !checked) return core::fail(checked.error());
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back((p - axis.point_mm).dot(axis.direction), distance_mm(axis, p));
  }
  const auto slope = ls_slope(points, mean_point(points));
  if (!slope) return core::fail(no_length());
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); });
  return Taper{*slope, 2.0 * *slope * (high->x() - low->x()), 2.0 * std::atan(*slope)};
}

}  // namespace rondure::fit
