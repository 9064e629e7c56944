#include "fit/one_sided_cylinder.h"

#include <algorithm>
#include <utility>

#include "fit/ls_line.h"
#include "fit/min_zone_line.h"
#include "fit/points.h"
#include "fit/zone_fit.h"
#include "fit/zone_proof.h"

namespace rondure::fit {
namespace {

/// The zone as it is stated: about the conventional point of the axis.
OneSidedCylinder stated(std::span<const Eigen::Vector3d> points_mm, const CylinderZone& zone,
                        const ZoneWeights& weights) {
  const bool outside = weights.outer > 0.0;
  const Axis axis = conventional(zone.place, mean_point(points_mm));
  const double half = half_extent(points_mm, axis.direction);
  const double round_off =
      distance_round_off(axis.point_mm.cwiseAbs().maxCoeff() + half + zone.outer_radius_mm);
  const CylinderFrame frame({Eigen::Vector3d::Zero(), axis.direction}, std::max(half, round_off));
  const auto proven = prove_zone(points_mm, axis.point_mm, frame, weights, round_off);
  OneSidedCylinder out;
  out.axis = axis;
  out.radius_mm = outside ? proven.zone.high : proven.zone.low;
  out.deviation_mm = proven.zone.width();
  const Contacts& contacts = outside ? proven.proof.outer : proven.proof.inner;
  out.contacts.assign(contacts.begin(), contacts.end());
  out.certificate = certify_local<4>(proven.proof, proven.zone.width(), round_off,
                                     "next to the least-squares axis");
  return out;
}

core::Result<OneSidedCylinder> fit_one_sided(std::span<const Eigen::Vector3d> points_mm,
                                             const std::optional<Eigen::Vector3d>& near_direction,
                                             const ZoneWeights& weights) {
  CylinderZoneFitter fitter;
  const auto zone = fitter.fit(points_mm, near_direction, weights);
  if (!zone) return core::fail(zone.error());
  return stated(points_mm, *zone, weights);
}

}  // namespace

core::Result<OneSidedCylinder> min_circumscribed_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction) {
  return fit_one_sided(points_mm, near_direction, kMinimumCircumscribed);
}

core::Result<OneSidedCylinder> max_inscribed_cylinder(
    std::span<const Eigen::Vector3d> points_mm,
    const std::optional<Eigen::Vector3d>& near_direction) {
  return fit_one_sided(points_mm, near_direction, kMaximumInscribed);
}

core::Result<MinZoneLine> min_zone_line(std::span<const Eigen::Vector3d> points_mm) {
  const auto line = ls_line(points_mm);
  if (!line) return core::fail(line.error());
  CylinderZoneFitter fitter;
  const CylinderZone zone = fitter.fit_from(points_mm, line->axis, kMinimumCircumscribed);
  OneSidedCylinder found = stated(points_mm, zone, kMinimumCircumscribed);
  MinZoneLine out;
  out.axis = found.axis;
  out.diameter_mm = 2.0 * found.radius_mm;
  out.contacts = std::move(found.contacts);
  out.certificate = std::move(found.certificate);
  out.certificate.scope = "next to the least-squares line";
  return out;
}

}  // namespace rondure::fit
