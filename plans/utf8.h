#pragma once

#include <cstddef>
#include <string_view>

namespace rondure::plans {

/// Index of the first byte that is not part of well-formed UTF-8 (RFC 3629), or text.size().
[[nodiscard]] std::size_t first_not_utf8(std::string_view text);

/// Characters (code points) of well-formed UTF-8.
[[nodiscard]] std::size_t characters(std::string_view text);

/// At most `bytes` of well-formed UTF-8, cut between characters.
[[nodiscard]] std::string_view head_of(std::string_view text, std::size_t bytes);

}  // namespace rondure::plans
