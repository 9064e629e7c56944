#include "plans/path/travel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr double kArcStep_rad = 15.0 * core::kDegree;  // longest side of a polygon around the part

Vector3d at(double radius_mm, double theta_rad, double z_mm) {
  return {radius_mm * std::cos(theta_rad), radius_mm * std::sin(theta_rad), z_mm};
}

double contact_radius(const PathGeometry& g) {
  return g.inside ? g.radius_mm - g.tip_radius_mm : g.radius_mm + g.tip_radius_mm;
}

SurfaceChart surface_of(const PathGeometry& g) {
  return g.surface.value_or(SurfaceChart(g.radius_mm, g.inside));
}

bool is_plane(const PathGeometry& g) {
  return g.surface && g.surface->shape() == record::Shape::kPlane;
}

/// Radius of the corners of the polygon around a shaft, chosen so that its sides keep the
/// clearance; 0, on the axis, for a bore.
double travel_radius(const PathGeometry& g) {
  if (g.inside) return 0.0;
  return (contact_radius(g) + std::max(g.approach_mm, g.clearance_mm) + g.stand_off_mm) /
         std::cos(0.5 * kArcStep_rad);
}

/// Angle and height of a pre-touch point.
struct Station {
  double theta_rad = 0.0;
  double z_mm = 0.0;
};

Station station_of(const PathGeometry& g, const Target& target) {
  if (!g.surface || g.surface->is_round()) return {target.theta_rad, target.z_mm};
  const Vector3d start = pre_touch(g, target);
  return {std::atan2(start.y(), start.x()), start.z()};
}

/// The place over a plane where the tip travels, before or after a touch.
Vector3d off_plane(const PathGeometry& g, const Target& target) {
  return g.surface->tip(target, g.tip_radius_mm, std::max(g.approach_mm, g.clearance_mm));
}

int arc_steps(double angle_rad) {
  // A small slack makes 45 deg three steps of 15 deg instead of four.
  return std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kArcStep_rad - 1e-9)));
}

}  // namespace

core::Result<void> check_fits(const PathGeometry& geometry) {
  if (!geometry.inside || contact_radius(geometry) - geometry.approach_mm >= 0.0) return {};
  return core::fail_with(core::Code::kMeaning,
                         "a tip radius of {:.7g} mm and an approach of {:.7g} mm exceed the bore "
                         "radius of {:.7g} mm; shorten the approach",
                         geometry.tip_radius_mm, geometry.approach_mm, geometry.radius_mm);
}

Vector3d approach_direction(const PathGeometry& geometry, const Target& target) {
  return surface_of(geometry).approach(target);
}

Vector3d contact_tip(const PathGeometry& geometry, const Target& target) {
  return surface_of(geometry).tip(target, geometry.tip_radius_mm, 0.0);
}

Vector3d pre_touch(const PathGeometry& geometry, const Target& target) {
  return surface_of(geometry).tip(target, geometry.tip_radius_mm, geometry.approach_mm);
}

Polyline entry_path(const PathGeometry& geometry, const Target& target) {
  const double radius_mm = travel_radius(geometry);
  const double above_mm = geometry.to_mm + geometry.tip_radius_mm + geometry.clearance_mm;
  const Vector3d start = pre_touch(geometry, target);
  if (is_plane(geometry)) {
    const Vector3d off = off_plane(geometry, target);
    if (geometry.surface->faces_up()) return {{off.x(), off.y(), above_mm}, off, start};
    return {at(radius_mm, target.theta_rad, above_mm), at(radius_mm, target.theta_rad, off.z()),
            off, start};
  }
  const Station beside = station_of(geometry, target);
  return {at(radius_mm, beside.theta_rad, above_mm), at(radius_mm, beside.theta_rad, beside.z_mm),
          start};
}

Polyline path_between(const PathGeometry& geometry, const Target& from, const Target& to) {
  Polyline path = {pre_touch(geometry, from)};
  if (is_plane(geometry)) {
    const Vector3d off = off_plane(geometry, from);
    const double radius_mm = off.head<2>().norm();
    const double turn_rad = std::remainder(to.theta_rad - from.theta_rad, core::kTwoPi);
    const int steps = arc_steps(turn_rad);
    path.push_back(off);
    for (int i = 1; i <= steps && turn_rad != 0.0; ++i) {
      path.push_back(at(radius_mm, from.theta_rad + turn_rad * i / steps, off.z()));
    }
    path.push_back(off_plane(geometry, to));
  } else if (!geometry.inside) {
    const double radius_mm = travel_radius(geometry);
    const Station first = station_of(geometry, from);
    const Station last = station_of(geometry, to);
    const double turn_rad = std::remainder(last.theta_rad - first.theta_rad, core::kTwoPi);
    path.push_back(at(radius_mm, first.theta_rad, first.z_mm));
    if (last.z_mm != first.z_mm) path.push_back(at(radius_mm, first.theta_rad, last.z_mm));
    const int steps = arc_steps(turn_rad);
    for (int i = 1; i <= steps && turn_rad != 0.0; ++i) {
      path.push_back(at(radius_mm, first.theta_rad + turn_rad * i / steps, last.z_mm));
    }
  }
  path.push_back(pre_touch(geometry, to));
  return path;
}

Polyline exit_path(const PathGeometry& geometry, const Target& target) {
  Polyline path = entry_path(geometry, target);
  std::reverse(path.begin(), path.end());
  return path;
}

Polyline path_around_sphere(const Vector3d& center_W_mm, double radius_mm,
                            const PathGeometry& geometry, const Vector3d& from,
                            const Vector3d& to) {
  const double start_mm = radius_mm + geometry.tip_radius_mm + geometry.approach_mm;
  const double corner_mm = start_mm / std::cos(0.5 * kArcStep_rad);
  const double turn_rad = std::atan2(from.cross(to).norm(), from.dot(to));
  // Between opposite directions of the equator all paths have the same length: go over the pole.
  Vector3d axis = from.cross(to);
  axis = axis.norm() > 1e-9 ? Vector3d(axis.normalized())
                            : Vector3d(from.cross(Vector3d::UnitZ()).normalized());
  const int steps = arc_steps(turn_rad);
  Polyline path = {center_W_mm + start_mm * from};
  for (int i = 0; i <= steps; ++i) {
    path.push_back(center_W_mm +
                   corner_mm * (Eigen::AngleAxisd(turn_rad * i / steps, axis) * from));
  }
  path.push_back(center_W_mm + start_mm * to);
  return path;
}

}  // namespace rondure::plans
