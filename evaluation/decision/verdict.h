#pragma once

#include <string_view>

namespace rondure::evaluation {

/// Verdict on a value and its tolerance. kVoid: no verdict is possible because a condition is
/// missing.
enum class Verdict { kConforms, kDoesNotConform, kUndecided, kVoid, kNotToleranced };

/// "conforms", "does not conform", "undecided", "void", "not toleranced".
[[nodiscard]] std::string_view name_of(Verdict verdict);

}  // namespace rondure::evaluation
