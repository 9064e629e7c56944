#pragma once

#include <string>
#include <string_view>

namespace rondure::fuzz {

// What a fuzzer feeds with bytes. Each gives "" or what went wrong, in words; a crash, a sanitizer
// report or an exception is wrong, too.

/// The grammar: what is read as a command is written and read again the same; responses likewise.
[[nodiscard]] std::string try_ipp_grammar(std::string_view bytes);

/// The server, line by line, with an ideal machine. The first byte chooses manner and pace;
/// every line it says must be a response, and every acknowledged command is completed once.
[[nodiscard]] std::string try_ipp_server(std::string_view bytes);

}  // namespace rondure::fuzz
