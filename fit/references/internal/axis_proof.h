#pragma once

#include <optional>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/references/internal/zone_proof.h"
#include "fit/zone/fit.h"
#include "fit/zone/global_search.h"

namespace rondure::fit {

/// The zone of a cylinder in its reported form, with its certificate.
struct AxisProof {
  Axis axis;  ///< Its point is midway between the ends of the points.
  double half_length = 0.0;
  ProvenZone<CylinderFrame> proven;
  Certificate certificate;
  ZoneEnding ending = ZoneEnding::kLimit;
  int boxes = 0;  ///< Boxes bounded by all searches.
  /// A better axis that was found but rejected, because it is outside the reach.
  std::optional<Axis> other;
};

/// States the zone about the axis of a fit, with its local certificate.
[[nodiscard]] AxisProof prove_axis(SpacePoints points_mm, const CylinderZone& found,
                                   const ZoneWeights& weights);

/// Searches the scopes in order until one is proven. A better axis that the search finds becomes
/// the start of a new descent, whose optimum becomes the result. A better axis outside `reach` is
/// only recorded in `other`.
///
/// @param reach  Region allowed for the axis of a one-sided reference; ignored for a minimum zone.
void search_scopes(SpacePoints points_mm, const CylinderProofOptions& options,
                   const ZoneWeights& weights, const AxisReach& reach, CylinderZoneFitter& fitter,
                   AxisProof& proof);

}  // namespace rondure::fit
