#pragma once

#include <ctime>

namespace rondure::test {

/// Processor time used by this process, all threads together [s]; work of other programs does not
/// count. Differences between two calls are held against limits.
inline double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

}  // namespace rondure::test
