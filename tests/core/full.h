#pragma once

#include <cstdlib>
#include <string_view>

// How much a test draws. The default path keeps small seeded cases that fail when the method is
// wrong; the counts behind the figures in docs/ run with RONDURE_FULL=1 (./test.sh --full).

namespace rondure::test {

/// Whether the full counts were asked for.
inline bool full() { return std::getenv("RONDURE_FULL") != nullptr; }

/// `few` cases by default, `of_full` with RONDURE_FULL=1; with RONDURE_FULL=all, for what takes
/// longer than `./test.sh --full` may, `of_all`.
inline int cases(int few, int of_full, int of_all) {
  if (!full()) return few;
  return std::string_view(std::getenv("RONDURE_FULL")) == "all" ? of_all : of_full;
}
inline int cases(int few, int of_full) { return cases(few, of_full, of_full); }

}  // namespace rondure::test
