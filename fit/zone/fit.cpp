#include "fit/zone/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <Eigen/LU>

#include "core/units.h"
#include "fit/geometry/column_extremes.h"
#include "fit/least_squares/sphere.h"

namespace rondure::fit {
namespace {

constexpr std::size_t kCenterSample = 48;
constexpr std::size_t kCylinderSample = 240;
/// With this many points or more one start is enough, whatever the arc (performance: small sets).
constexpr std::size_t kOneStart = 24;
constexpr std::size_t kSmall = 64;  // up to this number of points, more starts cost little
constexpr int kStarts = 8;          // starts around the axis, for each tilt
constexpr double kFullGap = 120.0 * core::kDegree;

/// Returns all points, or a sample of `most` of them, which is kept in `memory`.
template <class Point>
std::span<const Point> spread(std::span<const Point> points, std::size_t most,
                              std::vector<Point>& memory) {
  if (points.size() <= most) return points;
  memory.clear();
  for (std::size_t k = 0; k < most; ++k) memory.push_back(points[spread_row(k, points.size())]);
  return memory;
}

/// Rounding error of a distance: no place is farther from the origin than the extent of the points.
/// Not finite if a coordinate is not.
template <class Point>
double round_off_of(std::span<const Point> sample) {
  const std::span<const double> numbers(sample.front().data(),
                                        sample.size() * Point::SizeAtCompileTime);
  const double size = largest_magnitude(numbers);
  return std::isfinite(size) ? distance_round_off(size) : size;
}

template <class Place, class Frame>
ZoneFit<Place> zone_of(const Descent<Frame>& descent, const Place& place) {
  ZoneFit<Place> out;
  out.place = place;
  out.inner_radius_mm = descent.zone.low;
  out.outer_radius_mm = descent.zone.high;
  out.outer = descent.outer;
  out.inner = descent.inner;
  out.passes = descent.passes;
  out.pivots = descent.pivots;
  out.ending = descent.ending;
  return out;
}

/// Greatest distance of a reference from the least-squares one. The search for a maximum inscribed
/// reference that does not exist would never end; the minimum circumscribed one of an arc lies at
/// its chord.
double limit_of(const ZoneWeights& weights, double radius) {
  if (weights.outer == 0.0) return radius;
  return weights.inner == 0.0 ? 2.0 * radius : std::numeric_limits<double>::infinity();
}

/// Turns a fit into an error if it strayed or a number is not finite; else returns it unchanged.
template <class Place, class Point>
core::Result<ZoneFit<Place>> judged(ZoneFit<Place> zone, std::span<const Point> points,
                                    const ZoneWeights& weights, std::string_view shape) {
  if (zone.ending == ZoneEnding::kNotFinite) {
    TRY_DO(check_points(points));
    return core::fail(core::Code::kUnits,
                      "the coordinates are so large that squared distances are not finite; mm are "
                      "expected");
  }
  if (zone.ending == ZoneEnding::kStrayed) {
    return core::fail_with(
        core::Code::kReferenceAbsent,
        "there is no {} {} next to the least-squares one: the points do not surround it",
        weights.inner == 0.0 ? "minimum circumscribed" : "maximum inscribed", shape);
  }
  return zone;
}

core::Result<LsCircle> start_fit(PlanePoints points) { return algebraic_start(points); }
core::Result<LsSphere> start_fit(SpacePoints points) { return ls_sphere(points); }

/// Whether the contacts of a ball alone prove that the points are not on one line (in one plane):
/// they span a triangle (tetrahedron) that is not small compared with the ball.
template <class Point>
bool spans_space(std::span<const Point> points, const ZoneFit<Point>& ball) {
  constexpr int D = Point::SizeAtCompileTime;
  if (ball.outer.size() != D + 1) return false;
  Eigen::Matrix<double, D, D> sides;
  for (int k = 0; k < D; ++k) {
    sides.col(k) =
        (points[ball.outer[static_cast<std::size_t>(k) + 1].index] - points[ball.outer[0].index]) /
        ball.outer_radius_mm;
  }
  return std::abs(sides.determinant()) > 0.01;
}

/// The axis as a frame, with the extent of the points along it as the scale of its tilts.
CylinderFrame frame_of(SpacePoints sample, const Axis& axis, double round_off) {
  const double half = half_extent(sample, axis.direction);
  return {Axis{Eigen::Vector3d::Zero(), axis.direction}, std::max(half, round_off)};
}

/// The first `count` angles [rad].
struct Tilts {
  std::array<double, 3> angles{};
  std::size_t count = 0;

  [[nodiscard]] const double* begin() const { return angles.data(); }
  [[nodiscard]] const double* end() const { return angles.data() + count; }
};

/// Tilts of further starts where there may be several minima. Minimum zones of few points, or of
/// part of the circumference, may have distant ones; circumscribed and inscribed cylinders of few
/// points have close ones.
Tilts other_tilts(SpacePoints points, const LsCylinder& start, const ZoneWeights& weights) {
  if (weights.outer == 0.0 || weights.inner == 0.0) {
    if (points.size() > kSmall) return {};
    const double form = std::atan(start.deviation_mm / half_extent(points, start.axis.direction));
    return {{form, 4.0 * form}, 2};
  }
  if (points.size() >= kOneStart) return {};
  if (points.size() >= 12) {
    const auto frame = across(start.axis.direction);
    std::array<Eigen::Vector2d, kOneStart> flat;
    for (std::size_t i = 0; i < points.size(); ++i) {
      flat[i] = frame.transpose() * (points[i] - start.axis.point_mm);
    }
    const auto section = std::span(flat).first(points.size());
    if (largest_gap_rad(section, Eigen::Vector2d::Zero()) <= kFullGap) return {};
  }
  return {{0.5 * core::kDegree, 2.0 * core::kDegree, 6.0 * core::kDegree}, 3};
}

}  // namespace

template <int D>
auto CenterZoneFitter<D>::fit_from(std::span<const Point> points_mm, const Point& center_mm,
                                   const ZoneWeights& weights, double limit_mm) -> ZoneFit<Point> {
  const bool few = points_mm.size() <= kAllWorked;
  const double round_off =
      round_off_of(few ? points_mm : spread(points_mm, kCenterSample, sample_));
  const CenterFrame<D> start(Point::Zero());
  if (!std::isfinite(round_off)) {
    ZoneFit<Point> out;
    out.place = center_mm;
    out.ending = ZoneEnding::kNotFinite;
    return out;
  }
  const auto found = descent_.run(points_mm, center_mm, start, weights, round_off, limit_mm);
  return zone_of(found, found.frame.place(center_mm));
}

/// Finds the start from a sample, or from all points if the sample does not determine it.
template <int D>
auto CenterZoneFitter<D>::start_of(std::span<const Point> points_mm) -> core::Result<LsCenter<D>> {
  if (auto start = start_fit(spread(points_mm, kCenterSample, sample_))) return start;
  return start_fit(points_mm);
}

template <int D>
auto CenterZoneFitter<D>::fit(std::span<const Point> points_mm, const ZoneWeights& weights)
    -> core::Result<ZoneFit<Point>> {
  if (points_mm.empty()) return core::fail(core::Code::kNoPoints, "there are no points");
  constexpr std::string_view kShape = D == 2 ? "circle" : "sphere";
  if (weights.inner == 0.0) {
    // The problem is convex, so any start will do.
    const auto zone = fit_from(points_mm, points_mm.front(), weights);
    if (zone.ending == ZoneEnding::kConverged && !spans_space(points_mm, zone)) {
      TRY_DO(start_of(points_mm));
    }
    return judged(zone, points_mm, weights, kShape);
  }
  TRY(const auto start, start_of(points_mm));
  const double limit = limit_of(weights, start.radius_mm);
  return judged(fit_from(points_mm, start.center_mm, weights, limit), points_mm, weights, kShape);
}

template class CenterZoneFitter<2>;
template class CenterZoneFitter<3>;

CylinderZone CylinderZoneFitter::fit_from(SpacePoints points_mm, const Axis& axis,
                                          const ZoneWeights& weights, double limit_mm) {
  const auto sample = spread(points_mm, kCylinderSample, sample_);
  const double round_off = round_off_of(sample);
  const auto found = descent_.run(points_mm, axis.point_mm, frame_of(sample, axis, round_off),
                                  weights, round_off, limit_mm);
  return zone_of(found, found.frame.place(axis.point_mm));
}

CylinderZone CylinderZoneFitter::fit_around(SpacePoints points_mm, const Axis& axis,
                                            std::span<const double> tilts, CylinderZone best,
                                            const ZoneWeights& weights, double limit_mm) {
  int pivots = best.pivots;
  const auto side = across(axis.direction);
  for (const double tilt : tilts) {
    for (int k = 0; k < kStarts; ++k) {
      const double angle = core::kTwoPi * k / kStarts;
      const Eigen::Vector2d lean(std::cos(angle), std::sin(angle));
      const Eigen::Vector3d direction = axis.direction + std::tan(tilt) * (side * lean);
      const CylinderZone zone =
          fit_from(points_mm, {axis.point_mm, direction.normalized()}, weights, limit_mm);
      pivots += zone.pivots;
      const bool found = zone.ending == ZoneEnding::kConverged;
      if (found && weights.value({zone.inner_radius_mm, zone.outer_radius_mm}) <
                       weights.value({best.inner_radius_mm, best.outer_radius_mm}))
        best = zone;
    }
  }
  best.pivots = pivots;
  return best;
}

/// The best of several starts about the least-squares axis.
CylinderZone CylinderZoneFitter::fit_best(SpacePoints points_mm, const LsCylinder& start,
                                          const ZoneWeights& weights) {
  const double limit = limit_of(weights, start.radius_mm);
  const CylinderZone first = fit_from(points_mm, start.axis, weights, limit);
  const Tilts tilts = other_tilts(points_mm, start, weights);
  return fit_around(points_mm, start.axis, {tilts.begin(), tilts.end()}, first, weights, limit);
}

core::Result<CylinderZone> CylinderZoneFitter::fit(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const ZoneWeights& weights) {
  if (points_mm.empty()) return core::fail(core::Code::kNoPoints, "there are no points");
  auto start = ls_cylinder(spread(points_mm, kCylinderSample, sample_), near_direction);
  // A sample may miss a second layer of the data, or the row that is not finite.
  if (!start) start = ls_cylinder(points_mm, near_direction);
  if (!start) return core::fail(start.error());
  start_ = *start;
  return judged(fit_best(points_mm, start_, weights), points_mm, weights, "cylinder");
}

}  // namespace rondure::fit
