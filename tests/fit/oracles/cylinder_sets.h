#pragma once

// Simulated measured cylinders for the independent descent.

#include <cstdint>

#include "circle_sets.h"

namespace rondure::test {

/// Result of part().
struct Measured {
  Points3 points;
  double half_length_mm = 0.0;
};

/// A part with lobes, taper, barrel, bend and noise about z, radius 25 mm, form up to some 20 um;
/// discs of half-length 2.5 mm to shafts of 80 mm.
///
/// @param turn_rad  Arc covered by the points.
[[nodiscard]] Measured part(std::uint64_t seed, double turn_rad);

}  // namespace rondure::test
