#pragma once

#include "tests/core/full.h"

namespace rondure::test {

/// Number of seeded sets that a test draws: all with RONDURE_FULL=1, else a tenth, and a twentieth
/// under the sanitizers.
inline int count(int sets) {
#ifdef __SANITIZE_ADDRESS__
  return sets / 20 + 1;
#else
  return cases(sets / 10 + 1, sets);
#endif
}

}  // namespace rondure::test
