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

}  // namespace rondure::fit
