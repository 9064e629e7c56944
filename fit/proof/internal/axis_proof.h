#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/geometry/axis_scope.h"
#include "fit/proof/certificate.h"
#include "fit/proof/internal/zone_proof.h"
#include "fit/zone/fit.h"

namespace rondure::fit {

/// A zone of a cylinder as it is stated, with its certificate.
struct AxisProof {
  Axis axis;  ///< Its point midway between the ends of the points.
  double half_length = 0.0;
  ProvenZone<CylinderFrame> proven;
  Certificate certificate;
  ZoneEnding ending = ZoneEnding::kLimit;
  int linear_programs = 0;  ///< Of all descents.
  int boxes = 0;            ///< Bounded by all searches.
  /// A better axis that was met but is not taken, because it lies outside the reach.
  std::optional<Axis> other;
};

/// The zone about the axis of a fit, with its local certificate.
[[nodiscard]] AxisProof prove_axis(std::span<const Eigen::Vector3d> points_mm,
                                   const CylinderZone& found, const ZoneWeights& weights);

/// Searches the scopes in order until one is proven. A better axis met on the way becomes the start
/// of a new descent, and its optimum the result; unless it lies outside `reach`, which is then said
/// in `other`.
///
/// @param reach  Where the axis of a one-sided reference may lie; ignored for a minimum zone.
void search_scopes(std::span<const Eigen::Vector3d> points_mm, const CylinderProofOptions& options,
                   const ZoneWeights& weights, const AxisReach& reach, CylinderZoneFitter& fitter,
                   AxisProof& proof);

}  // namespace rondure::fit
