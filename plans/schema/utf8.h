#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace rondure::plans {

/// Index of the first byte that is not part of well-formed UTF-8 (RFC 3629), or text.size().
[[nodiscard]] std::size_t first_not_utf8(std::string_view text);

/// Index of the first character that a report cannot show, or text.size(): a control character
/// other than line feed and tab (DEL and U+0080..9F among them), a noncharacter (U+FDD0..FDEF,
/// U+FFFE and U+FFFF of every plane), or a byte that is not UTF-8.
[[nodiscard]] std::size_t first_unshowable(std::string_view text);

/// The character or byte at first_unshowable(), in words: "the character U+FFFE", "the byte 0xFF".
[[nodiscard]] std::string unshowable_in_words(std::string_view text, std::size_t index);

/// What forbids a name on page one, as a clause after it: it must fit its line, at most 200
/// characters, and not reorder what stands beside it. Nothing where it may stand there.
[[nodiscard]] std::optional<std::string> fault_of_name(std::string_view text);

/// The text on one line: a line feed becomes \n, other unshowable characters \u001b or \xff.
[[nodiscard]] std::string escaped_line(std::string_view text);

/// Number of characters (code points) of well-formed UTF-8.
[[nodiscard]] std::size_t characters(std::string_view text);

/// At most `bytes` of well-formed UTF-8, cut between characters.
[[nodiscard]] std::string_view head_of(std::string_view text, std::size_t bytes);

}  // namespace rondure::plans
