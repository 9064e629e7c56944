#pragma once

#include <functional>
#include <string>

namespace rondure::fuzz {

/// Runs a verb of the program in this process and looks at its answer.
/// @param verb  Gives its exit status; what it would print is kept from the terminal.
/// @return "" for a result without a number that is not finite, or for a sentence about what is
///         wrong; else what is wrong with the answer. All of it must be UTF-8.
[[nodiscard]] std::string wrong_with_answer(const std::function<int()>& verb);

/// The same of a text that is printed or written as it is, without control characters.
[[nodiscard]] std::string wrong_with_text(const std::string& text);

}  // namespace rondure::fuzz
