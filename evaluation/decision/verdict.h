#pragma once

#include <string_view>

namespace rondure::evaluation {

/// What is said of a value and its tolerance. kVoid: nothing can be said, a condition is missing.
enum class Verdict { kConforms, kDoesNotConform, kUndecided, kVoid, kNotToleranced };

/// "conforms", "does not conform", "undecided", "void", "not toleranced".
[[nodiscard]] std::string_view name_of(Verdict verdict);

}  // namespace rondure::evaluation
