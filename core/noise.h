#pragma once

#include <cstdint>
#include <initializer_list>

namespace rondure::core {

/// One step of splitmix64 (Steele, Lea, Flood 2014): advances `state` and returns 64 mixed bits.
[[nodiscard]] std::uint64_t splitmix64(std::uint64_t& state);

/// A stream of random numbers that depends only on its key, never on earlier draws elsewhere, so
/// that an interrupted simulation gives the same values as an uninterrupted one.
///
/// The key is the seed of the simulation and the numbers that identify the event, e.g. {stream,
/// touch id, repeat}. The same key gives the same numbers on every machine, up to the last bit of
/// log, sqrt and cos.
class KeyedNoise {
 public:
  KeyedNoise(std::uint64_t seed, std::initializer_list<std::uint64_t> key);

  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform();
  /// Standard normal by the Box-Muller transform; consumes two uniforms per call.
  [[nodiscard]] double normal();

 private:
  std::uint64_t state_;
};

}  // namespace rondure::core
