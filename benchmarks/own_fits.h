#pragma once

#include <span>

#include <Eigen/Core>

#include "benchmarks/sample_sets.h"
#include "fit/min_zone_circle.h"
#include "fit/min_zone_cylinder.h"

namespace rondure::benchmarks {

// The calls that are timed and judged, in one place: what changes here changes everywhere.

/// One minimum zone, with contacts and local proof, no global search.
[[nodiscard]] inline auto own_zone(const CylinderSet& set) {
  return fit::min_zone_cylinder(set.points_mm, set.start_direction);
}
[[nodiscard]] inline auto own_zone(const CircleSet& set) {
  return fit::min_zone_circle(set.points_mm, {.global = false, .search = {}});
}

/// The value as a report states it: proven global or marked as not proven.
[[nodiscard]] inline auto reported_zone(const CylinderSet& set) {
  fit::MinZoneCylinderOptions options;
  options.scopes = {{fit::AxisScope::Kind::kHalfSphere},
                    {fit::AxisScope::Kind::kCone, set.start_direction}};
  return fit::min_zone_cylinder(set.points_mm, set.start_direction, options);
}
[[nodiscard]] inline auto reported_zone(const CircleSet& set) {
  return fit::min_zone_circle(set.points_mm);
}

using OwnCylinder = decltype(own_zone(CylinderSet{}))::value_type;
using OwnCircle = decltype(own_zone(CircleSet{}))::value_type;

/// Where a zone lies.
[[nodiscard]] inline const fit::Axis& place_of(const fit::MinZoneCylinder& zone) {
  return zone.axis;
}
[[nodiscard]] inline const Eigen::Vector2d& place_of(const fit::MinZoneCircle& zone) {
  return zone.center_mm;
}

/// Passes over all points and pivots of the linear programmes; 0 where the fit does not tell.
struct Effort {
  int passes = 0;
  int pivots = 0;
};
[[nodiscard]] inline Effort effort_of(const OwnCylinder&) { return {}; }
[[nodiscard]] inline Effort effort_of(const OwnCircle&) { return {}; }

}  // namespace rondure::benchmarks
