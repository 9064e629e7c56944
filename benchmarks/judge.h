#pragma once

#include <string>

#include "benchmarks/own_fits.h"
#include "benchmarks/sample_sets.h"
#include "fit/proof/certificate.h"
#include "fit/zone/fit.h"

namespace rondure::benchmarks {

/// How good a zone is, told by routines that had no part in finding it.
struct Judgement {
  double width_um = 0.0;
  double excess = 0.0;  ///< (width - best known) / best known.
  std::string fault;    ///< Why the witness does not prove the zone; empty: it does.
};

/// Judges a zone of a set. Best known: the least of this zone, of the reported zone with its global
/// search (up to 1000 points), of Nelder and Mead (cylinders of up to 1e4) and of ten starts with
/// axes turned by up to 10 deg, centres moved by up to 0.5 mm; from 1e6 points on, for the first
/// six seeds only, one start for the others. It is kept for each set. The witness is checked by
/// fit/proof/certificate.h; here the gap of its multipliers, against 1e-10 of the width or the
/// round-off of distances, if that is more.
[[nodiscard]] Judgement judge(const SetKey& key, const CylinderSet& set, const fit::Axis& axis,
                              const fit::StatedZone& zone);
[[nodiscard]] Judgement judge(const SetKey& key, const CircleSet& set,
                              const Eigen::Vector2d& center_mm, const fit::StatedZone& zone);

/// (width - best known) / best known, of the width a peer states; below 0 if it states too little.
[[nodiscard]] double excess_of(const SetKey& key, const CylinderSet& set, double width_mm);
[[nodiscard]] double excess_of(const SetKey& key, const CircleSet& set, double width_mm);

/// The same judgement for what the fits return.
template <class Set, class Zone>
[[nodiscard]] Judgement judge(const SetKey& key, const Set& set, const Zone& zone) {
  Judgement out =
      judge(key, set, place_of(zone),
            fit::StatedZone{zone.inner_radius_mm, zone.outer_radius_mm, zone.outer, zone.inner});
  if constexpr (requires { zone.ending; }) {
    if (zone.ending != fit::ZoneEnding::kConverged) out.fault = "the fit did not converge";
  }
  return out;
}

}  // namespace rondure::benchmarks
