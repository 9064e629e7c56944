#include "fit/profiles/generatrix.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "fit/geometry/column_extremes.h"

namespace rondure::fit {
namespace {

/// Slope of the least-squares line r = mean + slope (z - mean z); nothing if all z are equal.
std::optional<double> ls_slope(PlanePoints points, const Eigen::Vector2d& mean) {
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
std::vector<Eigen::Vector2d> turned(PlanePoints points, const Eigen::Vector2d& mean, double slope) {
  const double scale = 1.0 / std::hypot(1.0, slope);
  std::vector<Eigen::Vector2d> out;
  out.reserve(points.size());
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d v = p - mean;
    out.emplace_back((v.x() + slope * v.y()) * scale, (v.y() - slope * v.x()) * scale);
  }
  return out;
}

core::Error no_length() {
  return {core::Code::kRank,
          "all points stand at one position along the axis; straightness and "
          "taper need at least two sections"};
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
  const auto frame = turned(points, mean, *slope);
  std::vector<double> deviations;
  for (const Eigen::Vector2d& p : frame) deviations.push_back(p.y());
  out.ls = form_parameters(deviations);
  out.zone_mm = least_width(frame);
  return out;
}

core::Result<Taper> taper(SpacePoints points_mm, const Axis& axis) {
  if (auto checked = check_points(points_mm); !checked) return core::fail(checked.error());
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& p : points_mm) {
    points.emplace_back((p - axis.point_mm).dot(axis.direction), distance_mm(axis, p));
  }
  const auto slope = ls_slope(points, mean_point(points));
  if (!slope) return core::fail(no_length());
  const double length = extremes_of(points, [](const auto& p) { return p.x(); }).width();
  return Taper{*slope, 2.0 * *slope * length, 2.0 * std::atan(*slope)};
}

}  // namespace rondure::fit
