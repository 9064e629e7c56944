#pragma once

#include <cstdint>

namespace rondure::benchmarks {

/// Heap allocations of this program so far: operator new, and malloc and its kin where our own
/// code calls them (Eigen does). What a shared library allocates for itself is not seen.
[[nodiscard]] std::uint64_t allocations();

}  // namespace rondure::benchmarks
