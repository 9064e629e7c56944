#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rondure::reports {

/// Columns of a line on a terminal.
inline constexpr std::size_t kTerminalColumns = 80;

/// Columns that UTF-8 text takes in a terminal; East Asian wide characters take two.
[[nodiscard]] std::size_t columns(std::string_view text);
/// The text followed by spaces up to `width` columns.
[[nodiscard]] std::string padded(std::string_view text, std::size_t width);

/// The text cut to at most `limit` columns, with "..." in place of the removed part.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t limit);

/// Where a line may be broken besides at spaces: before and after wide characters (Chinese has no
/// spaces), but not before closing nor after opening punctuation.
enum class LineBreaks { kAtSpaces, kAtWideCharacters };

/// The text in lines of at most kTerminalColumns columns, each with its line feed: the first after
/// `head`, the others indented to its end.
[[nodiscard]] std::string wrapped(std::string_view head, std::string_view text,
                                  LineBreaks breaks = LineBreaks::kAtSpaces);

}  // namespace rondure::reports
