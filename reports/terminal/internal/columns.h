#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports {

/// Columns of a line on a terminal.
inline constexpr std::size_t kTerminalColumns = 80;

/// Columns that UTF-8 text takes in a terminal; East Asian wide characters take two.
[[nodiscard]] std::size_t columns(std::string_view text);
/// The text with spaces behind it, `width` columns at least.
[[nodiscard]] std::string padded(std::string_view text, std::size_t width);

/// What a line may not be broken within: a word, or a wide character with the punctuation that
/// belongs to it.
struct LinePiece {
  std::string text;
  bool after_space = false;  ///< A space, or several, stood before it.
};
/// Text as its pieces: broken at spaces, and before and after wide characters (Chinese has no
/// spaces), but not before closing nor after opening punctuation.
[[nodiscard]] std::vector<LinePiece> line_pieces(std::string_view text);

/// The text cut to at most `limit` columns, with "..." where something was cut.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t limit);

}  // namespace rondure::reports
