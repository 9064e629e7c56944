#pragma once

#include <cstdlib>

namespace rondure::test {

/// Long counts run with RONDURE_FULL=1 (./test.sh --full); sanitizer builds run a tenth.
inline bool full() { return std::getenv("RONDURE_FULL") != nullptr; }

/// Number of seeded sets that a test draws: `sets` in a release build.
inline int count(int sets) {
#ifdef __SANITIZE_ADDRESS__
  return sets / 20 + 1;
#else
  return sets;
#endif
}

}  // namespace rondure::test
