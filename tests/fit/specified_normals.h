#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/noise.h"

namespace rondure::test {

/// Normals of the worked cases of the specification: splitmix64 from the seed, Box-Muller, two
/// draws a normal.
class SpecifiedNormals {
 public:
  explicit SpecifiedNormals(std::uint64_t seed) : state_(seed) {}
  double next() {
    const double u1 = uniform();
    const double u2 = uniform();
    return std::sqrt(-2.0 * std::log(1.0 - u1)) * std::cos(2.0 * std::numbers::pi * u2);
  }

 private:
  double uniform() { return static_cast<double>(core::splitmix64(state_) >> 11U) * 0x1.0p-53; }
  std::uint64_t state_;
};

}  // namespace rondure::test
