#include "core/noise.h"

#include <cmath>

#include "core/units.h"

namespace rondure::core {

std::uint64_t splitmix64(std::uint64_t& state) {
  state += 0x9e3779b97f4a7c15ULL;
  std::uint64_t z = state;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

KeyedNoise::KeyedNoise(std::uint64_t seed, std::initializer_list<std::uint64_t> key)
    : state_(seed) {
  // Mixes in each part of the key before the next one, so that (1, 2) and (2, 1) differ.
  for (const std::uint64_t part : key) state_ = splitmix64(state_) ^ part;
}

double KeyedNoise::uniform() { return static_cast<double>(splitmix64(state_) >> 11U) * 0x1.0p-53; }

double KeyedNoise::normal() {
  const double u1 = uniform();
  const double u2 = uniform();
  return std::sqrt(-2.0 * std::log1p(-u1)) * std::cos(kTwoPi * u2);
}

}  // namespace rondure::core
