#pragma once

#include <cstdint>
#include <initializer_list>

namespace rondure::core {

/// One step of splitmix64 (Steele, Lea, Flood 2014): advances `state`, returns 64 mixed bits.
[[nodiscard]] std::uint64_t splitmix64(std::uint64_t& state);

/// A stream of random numbers that depends on its key alone, never on what was drawn elsewhere
/// before: an interrupted and an uninterrupted simulation see the same world.
///
/// Key: the seed of the simulation and the numbers that name the event, e.g. {stream, touch id,
/// repeat}. Same key, same numbers, on every machine up to the last bit of log, sqrt and cos.
class KeyedNoise {
 public:
  KeyedNoise(std::uint64_t seed, std::initializer_list<std::uint64_t> key);

  /// Uniform in [0, 1), 53 bits.
  [[nodiscard]] double uniform();
  /// Standard normal by Box and Muller; two uniforms a call.
  [[nodiscard]] double normal();

 private:
  std::uint64_t state_;
};

}  // namespace rondure::core
