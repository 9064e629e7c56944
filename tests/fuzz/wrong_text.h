#pragma once

#include <string>

#include "core/error.h"

namespace rondure::fuzz {

/// Checks the words of a text: "" when it is UTF-8 and every number in it is finite, otherwise a
/// description of the fault.
[[nodiscard]] std::string wrong_with_words(const std::string& text);

/// The same check for a text that is printed or written; it must hold no control characters.
[[nodiscard]] std::string wrong_with_text(const std::string& text);

/// Checks the line that a refusal is printed as: a sentence in UTF-8 without control characters. It
/// may name a number that was found and is none.
[[nodiscard]] std::string wrong_with_refusal(const core::Error& refusal);

}  // namespace rondure::fuzz
