#include "fit/references/min_zone_sphere.h"

#include "fit/references/internal/zone_proof.h"
#include "fit/zone/fit.h"

namespace rondure::fit {

core::Result<MinZoneSphere> min_zone_sphere(std::span<const Eigen::Vector3d> points_mm) {
  SphereZoneFitter fitter;
  const auto zone = fitter.fit(points_mm);
  if (!zone) return core::fail(zone.error());
  const double round_off =
      distance_round_off(zone->place.cwiseAbs().maxCoeff() + zone->outer_radius_mm);
  const CenterFrame<3> frame(Eigen::Vector3d::Zero());
  const auto proven = prove_zone(points_mm, zone->place, frame, kMinimumZone, round_off);
  MinZoneSphere out;
  out.center_mm = zone->place;
  out.inner_radius_mm = proven.zone.low;
  out.outer_radius_mm = proven.zone.high;
  out.outer.assign(proven.proof.outer.begin(), proven.proof.outer.end());
  out.inner.assign(proven.proof.inner.begin(), proven.proof.inner.end());
  out.certificate = certify_local<3>(proven.proof, out.width_mm(), round_off,
                                     core::Phrase("next to the least-squares centre"));
  return out;
}

}  // namespace rondure::fit
