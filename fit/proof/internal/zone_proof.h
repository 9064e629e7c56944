#pragma once

#include <span>

#include <Eigen/Core>

#include "fit/proof/local_certificate.h"
#include "fit/zone/descent.h"

namespace rondure::fit {

/// A zone as it is stated: about a place that has its final digits.
template <class Frame>
struct ProvenZone {
  Extremes zone;  ///< Of all points about the place.
  LocalProof<Frame::kUnknowns> proof;
};

/// States the zone about a place and proves what the points within round-off of it can.
///
/// @param frame  Relative to `origin`. Cost: one pass over all points, and the contacts.
template <class Frame>
[[nodiscard]] ProvenZone<Frame> prove_zone(std::span<const typename Frame::Point> points,
                                           const typename Frame::Point& origin, const Frame& frame,
                                           const ZoneWeights& weights, double round_off);

}  // namespace rondure::fit
