#include "plans/path/travel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

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

double pre_touch_radius(const PathGeometry& g) {
  return contact_radius(g) + (g.inside ? -g.approach_mm : g.approach_mm);
}

/// Radius of the corners of the polygon around a shaft, chosen so that its sides keep the
/// clearance; 0, on the axis, for a bore.
double travel_radius(const PathGeometry& g) {
  if (g.inside) return 0.0;
  return (contact_radius(g) + std::max(g.approach_mm, g.clearance_mm) + g.stand_off_mm) /
         std::cos(0.5 * kArcStep_rad);
}

int arc_steps(double angle_rad) {
  // A small slack makes 45 deg three steps of 15 deg instead of four.
  return std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kArcStep_rad - 1e-9)));
}

}  // namespace

core::Result<void> check_fits(const PathGeometry& geometry) {
  if (!geometry.inside || pre_touch_radius(geometry) >= 0.0) return {};
  return core::fail(core::Code::kMeaning,
                    fmt::format("a tip radius of {:.7g} mm and an approach of {:.7g} mm exceed the "
                                "bore radius of {:.7g} mm; shorten the approach",
                                geometry.tip_radius_mm, geometry.approach_mm, geometry.radius_mm));
}

Vector3d approach_direction(const PathGeometry& geometry, const Target& target) {
  return at(geometry.inside ? 1.0 : -1.0, target.theta_rad, 0.0);
}

Vector3d contact_tip(const PathGeometry& geometry, const Target& target) {
  return at(contact_radius(geometry), target.theta_rad, target.z_mm);
}

Vector3d pre_touch(const PathGeometry& geometry, const Target& target) {
  return at(pre_touch_radius(geometry), target.theta_rad, target.z_mm);
}

Polyline entry_path(const PathGeometry& geometry, const Target& target) {
  const double radius_mm = travel_radius(geometry);
  const double above_mm = geometry.to_mm + geometry.tip_radius_mm + geometry.clearance_mm;
  return {at(radius_mm, target.theta_rad, above_mm), at(radius_mm, target.theta_rad, target.z_mm),
          pre_touch(geometry, target)};
}

Polyline path_between(const PathGeometry& geometry, const Target& from, const Target& to) {
  Polyline path = {pre_touch(geometry, from)};
  if (!geometry.inside) {
    const double radius_mm = travel_radius(geometry);
    const double turn_rad = std::remainder(to.theta_rad - from.theta_rad, core::kTwoPi);
    path.push_back(at(radius_mm, from.theta_rad, from.z_mm));
    if (to.z_mm != from.z_mm) path.push_back(at(radius_mm, from.theta_rad, to.z_mm));
    const int steps = arc_steps(turn_rad);
    for (int i = 1; i <= steps && turn_rad != 0.0; ++i) {
      path.push_back(at(radius_mm, from.theta_rad + turn_rad * i / steps, to.z_mm));
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
