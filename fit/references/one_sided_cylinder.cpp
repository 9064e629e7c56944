#include "fit/references/one_sided_cylinder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "fit/least_squares/line.h"
#include "fit/references/internal/axis_proof.h"
#include "fit/references/min_zone_line.h"

namespace rondure::fit {
namespace {

OneSidedCylinder stated(SpacePoints points_mm, const AxisProof& proof, const ZoneWeights& weights) {
  const bool outside = weights.outer > 0.0;
  const Extremes& zone = proof.proven.zone;
  OneSidedCylinder out;
  out.axis = conventional(proof.axis, mean_point(points_mm));
  out.radius_mm = outside ? zone.high : zone.low;
  out.deviation_mm = zone.width();
  const LocalProof<4>& local = proof.proven.proof;
  const Contacts& contacts = outside ? local.outer : local.inner;
  out.contacts.assign(contacts.begin(), contacts.end());
  out.certificate = proof.certificate;
  if (!proof.other) return out;
  OneSidedCylinder::Other other;
  const Extremes radii =
      extremes_of(points_mm, [&](const auto& p) { return distance_mm(*proof.other, p); });
  other.radius_mm = outside ? radii.high : radii.low;
  other.lean_rad =
      std::asin(std::min(1.0, proof.axis.direction.cross(proof.other->direction).norm()));
  other.apart_mm = distance_mm(*proof.other, proof.axis.point_mm);
  out.other = other;
  return out;
}

core::Result<OneSidedCylinder> fit_one_sided(SpacePoints points_mm,
                                             const std::optional<Eigen::Vector3d>& near_direction,
                                             const ZoneWeights& weights,
                                             const CylinderProofOptions& options) {
  CylinderZoneFitter fitter;
  const auto zone = fitter.fit(points_mm, near_direction, weights);
  if (!zone) return core::fail(zone.error());
  AxisProof proof = prove_axis(points_mm, *zone, weights);
  // Circumscribed: two radii, the limit of the descent. Inscribed: less than that limit, so that
  // all axes of the scope stay inside the points.
  const LsCylinder& start = fitter.start();
  const AxisReach reach{start.axis, (weights.outer > 0.0 ? 2.0 : 0.5) * start.radius_mm};
  search_scopes(points_mm, options, weights, reach, fitter, proof);
  return stated(points_mm, proof, weights);
}

}  // namespace

core::Result<OneSidedCylinder> min_circumscribed_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const CylinderProofOptions& options) {
  return fit_one_sided(points_mm, near_direction, kMinimumCircumscribed, options);
}

core::Result<OneSidedCylinder> max_inscribed_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const CylinderProofOptions& options) {
  return fit_one_sided(points_mm, near_direction, kMaximumInscribed, options);
}

core::Result<MinZoneLine> min_zone_line(SpacePoints points_mm, Proof proof) {
  const auto line = ls_line(points_mm);
  if (!line) return core::fail(line.error());
  CylinderZoneFitter fitter;
  const CylinderZone zone = fitter.fit_from(points_mm, line->axis, kMinimumCircumscribed);
  if (proof == Proof::kNone) return MinZoneLine{zone.place, 2.0 * zone.outer_radius_mm, {}, {}};
  OneSidedCylinder found =
      stated(points_mm, prove_axis(points_mm, zone, kMinimumCircumscribed), kMinimumCircumscribed);
  MinZoneLine out;
  out.axis = found.axis;
  out.diameter_mm = 2.0 * found.radius_mm;
  out.contacts = std::move(found.contacts);
  out.certificate = std::move(found.certificate);
  out.certificate.scope = core::phrase("next to the least-squares line");
  return out;
}

}  // namespace rondure::fit
