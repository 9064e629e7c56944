#pragma once

#include <functional>
#include <string>

namespace rondure::fuzz {

/// Runs a verb of the program in this process and checks its output.
/// @param verb  Returns its exit status; its output is captured.
/// @return  "" for a result with only finite numbers, or for an error message; otherwise a
///          description of the fault. All output must be UTF-8.
[[nodiscard]] std::string wrong_with_answer(const std::function<int()>& verb);

/// The same check for a text that is printed or written; it must hold no control characters.
[[nodiscard]] std::string wrong_with_text(const std::string& text);

}  // namespace rondure::fuzz
