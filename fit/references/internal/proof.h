#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/proof/certificate.h"
#include "fit/zone/descent.h"
#include "fit/zone/fit.h"
#include "fit/zone/global_search.h"
#include "fit/zone/local_certificate.h"

namespace rondure::fit {

/// A zone in its reported form: about a place with its final digits.
template <class Frame>
struct ProvenZone {
  Extremes zone;  ///< Extreme distances of all points from the place.
  LocalProof<Frame::kUnknowns> proof;
};

/// States the zone about a place and derives the local proof from the points in contact to
/// round-off. Cost: one pass over all points, and the contacts.
///
/// @param frame  The place, relative to `origin`.
template <class Frame>
[[nodiscard]] ProvenZone<Frame> prove_zone(std::span<const typename Frame::Point> points,
                                           const typename Frame::Point& origin, const Frame& frame,
                                           const ZoneWeights& weights, double round_off);

/// States the minimum zone about a centre: radii, contacts, and the local certificate.
/// @param out  A MinZoneCenter<D>.
/// @return The first-order growth there.
template <int D, class MinZone>
double state_zone(std::span<const Eigen::Matrix<double, D, 1>> points,
                  const Eigen::Matrix<double, D, 1>& center, double round_off, MinZone& out) {
  const CenterFrame<D> frame(Eigen::Matrix<double, D, 1>::Zero());
  const auto proven = prove_zone(points, center, frame, kMinimumZone, round_off);
  out.center_mm = center;
  out.inner_radius_mm = proven.zone.low;
  out.outer_radius_mm = proven.zone.high;
  out.outer.assign(proven.proof.outer.begin(), proven.proof.outer.end());
  out.inner.assign(proven.proof.inner.begin(), proven.proof.inner.end());
  out.certificate = certify_local<D>(proven.proof, out.width_mm(), round_off,
                                     core::Phrase("next to the least-squares centre"));
  return proven.proof.growth;
}

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
