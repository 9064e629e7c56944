#include "fit/references/min_zone_cylinder.h"

#include "fit/references/internal/axis_proof.h"

namespace rondure::fit {

core::Result<MinZoneCylinder> min_zone_cylinder(
    SpacePoints points_mm, const std::optional<Eigen::Vector3d>& near_direction,
    const CylinderProofOptions& options) {
  CylinderZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm, near_direction));
  AxisProof proof = prove_axis(points_mm, zone, kMinimumZone);
  search_scopes(points_mm, options, kMinimumZone, {}, fitter, proof);
  MinZoneCylinder out;
  out.axis = conventional(proof.axis, mean_point(points_mm));
  out.inner_radius_mm = proof.proven.zone.low;
  out.outer_radius_mm = proof.proven.zone.high;
  out.boxes = proof.boxes;
  out.ending = proof.ending;
  out.certificate = proof.certificate;
  const LocalProof<4>& local = proof.proven.proof;
  out.outer.assign(local.outer.begin(), local.outer.end());
  out.inner.assign(local.inner.begin(), local.inner.end());
  return out;
}

}  // namespace rondure::fit
