#include "cylinder_sets.h"

#include <cmath>

#include "core/noise.h"
#include "core/units.h"

namespace rondure::test {

Measured part(std::uint64_t seed, double turn_rad) {
  core::KeyedNoise noise(seed, {101});
  const int layers = 3 + static_cast<int>(seed % 3);
  const int around = 5 + static_cast<int>(seed / 3 % 5);
  const double half = 25.0 * std::pow(10.0, 1.5 * noise.uniform() - 1.0);
  const double form = 0.02 * noise.uniform() + 1e-4;
  const double phase = core::kTwoPi * noise.uniform();
  const double bend = noise.normal();
  const double taper = noise.normal();
  Measured out;
  out.half_length_mm = half;
  for (int k = 0; k < layers * around; ++k) {
    const double q = 2.0 * (k % layers) / (layers - 1) - 1.0;
    const double angle = turn_rad * (k / layers + 0.7 * noise.uniform()) / around;
    const double shape = std::cos((2.0 + static_cast<double>(seed % 4)) * angle + phase) +
                         bend * (q * q - 0.5) * std::cos(angle) + 0.5 * taper * q +
                         0.3 * noise.normal();
    const double r = 25.0 + form * shape;
    out.points.emplace_back(r * std::cos(angle), r * std::sin(angle), half * q);
  }
  return out;
}

}  // namespace rondure::test
