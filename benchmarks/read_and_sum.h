#pragma once

#include <span>

namespace rondure::benchmarks {

/// The least that can be done with the points: reads each number once and adds it. S1 is held
/// against it (gate R0), with the processor's widest SIMD as S1 has.
[[nodiscard]] double read_and_sum(std::span<const double> numbers);

}  // namespace rondure::benchmarks
