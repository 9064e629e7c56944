#include "benchmarks/read_and_sum.h"

#include <array>
#include <cstddef>

namespace rondure::benchmarks {
namespace {

[[gnu::target_clones("avx2", "default")]] double sum(const double* p, std::size_t count) {
  constexpr std::size_t kLanes = 16;  // independent sums: no addition waits for another
  std::array<double, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) sums[j] += p[i + j];
  }
  double out = 0.0;
  for (; i < count; ++i) out += p[i];
  for (const double lane : sums) out += lane;
  return out;
}

}  // namespace

double read_and_sum(std::span<const double> numbers) { return sum(numbers.data(), numbers.size()); }

}  // namespace rondure::benchmarks
