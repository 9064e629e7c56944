#pragma once

#include <cmath>

#include <Eigen/Core>

#include "benchmarks/sample_sets.h"
#include "fit/geometry/scan.h"
#include "fit/least_squares/cylinder.h"
#include "fit/references/min_zone.h"
#include "fit/zone/fit.h"

namespace rondure::benchmarks {

// The calls that are timed and judged, in one place: what changes here changes everywhere. The
// fitters live as long as the program, as in a loop over the sections of a part.

[[nodiscard]] inline auto own_fit(const CylinderSet& set, const fit::ZoneWeights& weights) {
  static fit::CylinderZoneFitter fitter;
  return fitter.fit(set.points_mm, set.start_direction, weights);
}
[[nodiscard]] inline auto own_fit(const CircleSet& set, const fit::ZoneWeights& weights) {
  static fit::CircleZoneFitter fitter;
  return fitter.fit(set.points_mm, weights);
}

/// One minimum zone, with contacts and multipliers, no global search.
template <class Set>
[[nodiscard]] auto own_zone(const Set& set) {
  return own_fit(set, fit::kMinimumZone);
}

/// The value as a report states it: proven global or marked as not proven.
[[nodiscard]] inline auto reported_zone(const CylinderSet& set) {
  fit::CylinderProofOptions options;
  options.scopes = {{fit::AxisScope::Kind::kHalfSphere},
                    {fit::AxisScope::Kind::kCone, set.start_direction}};
  return fit::min_zone_cylinder(set.points_mm, set.start_direction, options);
}
[[nodiscard]] inline auto reported_zone(const CircleSet& set) {
  return fit::min_zone_circle(set.points_mm);
}

/// Least squares, minimum zone, minimum circumscribed and maximum inscribed cylinder.
struct AllCriteria {
  core::Result<fit::LsCylinder> ls;
  core::Result<fit::CylinderZone> mz;
  core::Result<fit::CylinderZone> mc;
  core::Result<fit::CylinderZone> mi;
};
[[nodiscard]] inline AllCriteria own_criteria(const CylinderSet& set) {
  return {fit::ls_cylinder(set.points_mm, set.start_direction), own_zone(set),
          own_fit(set, fit::kMinimumCircumscribed), own_fit(set, fit::kMaximumInscribed)};
}

/// Radial gap about an axis, by S1 [mm].
[[nodiscard]] inline double width_about_mm(const CylinderSet& set, const fit::Axis& axis) {
  const auto extremes = fit::scan(set.points_mm, axis);
  return std::sqrt(extremes.high) - std::sqrt(extremes.low);
}

/// Where a zone lies.
template <class Place>
[[nodiscard]] const Place& place_of(const fit::ZoneFit<Place>& zone) {
  return zone.place;
}
[[nodiscard]] inline const fit::Axis& place_of(const fit::MinZoneCylinder& zone) {
  return zone.axis;
}
[[nodiscard]] inline const Eigen::Vector2d& place_of(const fit::MinZoneCircle& zone) {
  return zone.center_mm;
}

}  // namespace rondure::benchmarks
