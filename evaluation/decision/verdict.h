#pragma once

#include <string_view>

#include "core/words.h"

namespace rondure::evaluation {

/// Verdict on a value and its tolerance. kVoid: no verdict is possible because a condition is
/// missing.
enum class Verdict { kConforms, kDoesNotConform, kUndecided, kVoid, kNotToleranced };

RONDURE_WORDS(Verdict, {kConforms, "conforms"}, {kDoesNotConform, "does not conform"},
              {kUndecided, "undecided"}, {kVoid, "void"}, {kNotToleranced, "not toleranced"});

/// Severity of a verdict, for the verdict on several lines or on several limits of one: the most
/// severe is that of all. From the least: not toleranced, conforms, undecided, void, does not
/// conform. What does not conform is proven, whatever else could not be judged.
[[nodiscard]] int severity(Verdict verdict);

}  // namespace rondure::evaluation
