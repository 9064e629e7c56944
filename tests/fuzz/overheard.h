#pragma once

#include <functional>
#include <string>

#include "tests/fuzz/wrong_text.h"

namespace rondure::fuzz {

/// Runs a verb of the program in this process and checks its output.
/// @param verb  Returns its exit status; its output is captured.
/// @return  "" for a result with only finite numbers, or for an error message; otherwise a
///          description of the fault. All output must be UTF-8.
[[nodiscard]] std::string wrong_with_answer(const std::function<int()>& verb);

}  // namespace rondure::fuzz
