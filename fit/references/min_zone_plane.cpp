#include "fit/references/min_zone_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fit/geometry/axis.h"
#include "fit/geometry/column_extremes.h"
#include "fit/geometry/zone_rows.h"
#include "fit/least_squares/plane.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {
namespace {

constexpr int kProgrammes = 20;
/// A slope below this moves a point of a plane of 1 m by less than its rounding.
constexpr double kAtRest = 1e-15;
/// A bound this close counts as the value; results are required to 1e-9 mm.
constexpr double kProven = 1e-9;

/// The points relative to their mean, within the plane and across it.
struct FlatPoints {
  std::vector<Eigen::Vector2d> within;
  std::vector<double> heights;
  double reach = 0.0;  ///< Greatest distance from the mean within the plane.
};

FlatPoints flat_points(SpacePoints points, const Plane& plane) {
  const auto frame = across(plane.normal);
  FlatPoints out;
  for (const Eigen::Vector3d& p : points) {
    out.within.emplace_back(frame.transpose() * (p - plane.point_mm));
    out.heights.push_back(height_mm(plane, p));
    out.reach = std::max(out.reach, out.within.back().norm());
  }
  return out;
}

/// Least range of the heights over all slopes; the step is a slope times `reach`.
ZoneStep<2> least_range(const FlatPoints& points) {
  ZoneRows<2> rows;
  for (std::size_t i = 0; i < points.within.size(); ++i) {
    rows.push_back(points.heights[i], -points.within[i] / points.reach);
  }
  return solve_zone_program<2>(rows, points.reach);
}

/// How fast the range grows with the slope, at least: the distance of the origin from the sides of
/// the hull of the differences of lower and upper contacts; 0 if it is not inside.
double growth(const FlatPoints& points, const ZoneStep<2>& step) {
  std::vector<Eigen::Vector2d> differences;
  for (const Contact& low : step.inner) {
    for (const Contact& high : step.outer) {
      differences.push_back(points.within[low.index] - points.within[high.index]);
    }
  }
  const auto hull = convex_hull(differences);
  if (hull.size() < 3) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d side = hull[(i + 1) % hull.size()] - hull[i];
    least = std::min(least, (side.x() * -hull[i].y() + side.y() * hull[i].x()) / side.norm());
  }
  return std::max(0.0, least);
}

Certificate plane_certificate(const FlatPoints& points, const ZoneStep<2>& step, double width,
                              double extent) {
  // Every pair of multipliers that sum to 1 gives a lower bound of the range at any slope, apart
  // from the imbalance of their points.
  double bound = 0.0;
  for (const Contact& c : step.outer) bound += c.multiplier * points.heights[c.index];
  for (const Contact& c : step.inner) bound -= c.multiplier * points.heights[c.index];
  bound = std::min(bound, width);
  const double farthest = 2.0 * width / (extent - width);
  const bool sharp = growth(points, step) >= 0.5 * width * farthest;
  const double gap = width - (sharp ? bound : bound / std::hypot(1.0, farthest));
  Certificate out{Certificate::Kind::kGlobal, core::phrase("all directions"), gap, {}};
  if (gap > kProven) {
    out.kind = Certificate::Kind::kLocal;
    out.reason = core::phrase("the contacts hold the zone to first order only");
  }
  return out;
}

}  // namespace

core::Result<MinZonePlane> min_zone_plane(SpacePoints points_mm,
                                          const std::optional<Eigen::Vector3d>& outward) {
  TRY(const auto start, ls_plane(points_mm, outward));
  MinZonePlane out;
  Plane plane = start.plane;
  FlatPoints points = flat_points(points_mm, plane);
  ZoneStep<2> step = least_range(points);
  for (int i = 0; i < kProgrammes && step.solved && step.inside_box; ++i) {
    const Eigen::Vector2d slope = step.step / points.reach;
    if (slope.norm() <= kAtRest) {
      out.ending = ZoneEnding::kConverged;
      break;
    }
    plane.normal = (plane.normal - across(plane.normal) * slope).normalized();
    points = flat_points(points_mm, plane);
    step = least_range(points);
  }
  const Extremes heights = extremes_of(points.heights, [](double h) { return h; });
  const double extent = least_width(points.within);
  out.width_mm = heights.width();
  if (!(extent > out.width_mm)) {
    return core::fail_with(core::Code::kRank,
                           "the points extend {:.6g} mm within the plane and {:.6g} mm across it: "
                           "no plane is distinguished; measure a larger face",
                           extent, out.width_mm);
  }
  out.outer = {plane.point_mm + heights.high * plane.normal, plane.normal};
  out.top.assign(step.outer.begin(), step.outer.end());
  out.bottom.assign(step.inner.begin(), step.inner.end());
  if (out.ending == ZoneEnding::kConverged) {
    out.certificate = plane_certificate(points, step, out.width_mm, extent);
  }
  return out;
}

}  // namespace rondure::fit
