#pragma once

#include <span>

#include <Eigen/Core>

#include "fit/zone/descent.h"
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

}  // namespace rondure::fit
