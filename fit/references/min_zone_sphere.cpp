#include "fit/references/min_zone_sphere.h"

#include "fit/references/internal/zone_proof.h"
#include "fit/zone/fit.h"

namespace rondure::fit {

core::Result<MinZoneSphere> min_zone_sphere(SpacePoints points_mm) {
  SphereZoneFitter fitter;
  TRY(const auto zone, fitter.fit(points_mm));
  const double round_off =
      distance_round_off(zone.place.cwiseAbs().maxCoeff() + zone.outer_radius_mm);
  MinZoneSphere out;
  state_zone<3>(points_mm, zone.place, round_off, out);
  return out;
}

}  // namespace rondure::fit
