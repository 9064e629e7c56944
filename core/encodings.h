#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace rondure::core {

/// Bytes in base64 (RFC 4648), padded.
[[nodiscard]] std::string base64(std::string_view bytes);

inline constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  ///< U+FFFD

/// One character of UTF-8 text; a byte that starts none is a character by itself.
struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = true;
};
/// The first character of a text that is not empty.
[[nodiscard]] Utf8Character next_character(std::string_view text);

[[nodiscard]] bool is_control(std::uint32_t code);
/// Codes that are no characters: XML and HTML refuse them.
[[nodiscard]] bool is_noncharacter(std::uint32_t code);

/// Marks that reorder what follows or break its line (U+202E, U+2028), and marks without width.
[[nodiscard]] bool is_layout_mark(std::uint32_t code);

/// The text as well-formed UTF-8 without NUL; what is neither becomes U+FFFD.
[[nodiscard]] std::string well_formed(std::string_view text);

/// Text for a terminal: control characters, line breaks and marks that change the direction of
/// writing become "?".
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace rondure::core
