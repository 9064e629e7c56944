#pragma once

#include <cstdlib>

// How much a test draws. The default path keeps small seeded cases that fail when the method is
// wrong; the counts behind the figures in docs/ run with RONDURE_FULL=1 (./test.sh --full).

namespace rondure::test {

/// Whether the full counts were asked for.
inline bool full() { return std::getenv("RONDURE_FULL") != nullptr; }

/// `few` cases by default, `of_full` with RONDURE_FULL=1.
inline int cases(int few, int of_full) { return full() ? of_full : few; }

}  // namespace rondure::test
