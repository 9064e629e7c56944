#pragma once

#include <string>
#include <string_view>

namespace rondure::fuzz {

// Entry points for a fuzzer. Each takes bytes and returns "" or a description of the fault; a
// crash, a sanitizer report or an exception is a fault, too.

/// Tests the grammar: a command that is read must be equal after writing and reading; responses
/// likewise.
[[nodiscard]] std::string try_ipp_grammar(std::string_view bytes);

/// Tests the server, line by line, with an ideal machine. The first byte selects
/// options and timing; every line from the server must be a response, and every acknowledged
/// command must be completed once.
[[nodiscard]] std::string try_ipp_server(std::string_view bytes);

}  // namespace rondure::fuzz
