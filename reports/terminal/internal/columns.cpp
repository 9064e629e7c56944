#include "reports/terminal/internal/columns.h"

#include <array>
#include <cstdint>
#include <vector>

#include "core/encodings.h"

namespace rondure::reports {
namespace {

bool is_wide(std::uint32_t code) {
  constexpr std::array<std::array<std::uint32_t, 2>, 8> kWide = {{{0x1100, 0x115F},
                                                                  {0x2E80, 0xA4CF},
                                                                  {0xAC00, 0xD7A3},
                                                                  {0xF900, 0xFAFF},
                                                                  {0xFE30, 0xFE6F},
                                                                  {0xFF00, 0xFF60},
                                                                  {0x1F300, 0x1FAFF},
                                                                  {0x20000, 0x3FFFD}}};
  for (const auto& range : kWide) {
    if (code >= range[0] && code <= range[1]) return true;
  }
  return false;
}

/// Punctuation that no line may begin with, and below that none may end with.
bool closes(std::string_view letter) {
  constexpr std::string_view kMarks = "，。；：、）》”！？·%)],.;:";
  return kMarks.find(letter) != std::string_view::npos;
}
bool opens(std::string_view letter) {
  constexpr std::string_view kMarks = "（《“([";
  return kMarks.find(letter) != std::string_view::npos;
}

/// A piece that is never broken: a word, or a wide character with its punctuation.
struct LinePiece {
  std::string text;
  bool after_space = false;  ///< Follows one or several spaces.
};

std::vector<LinePiece> line_pieces(std::string_view text, LineBreaks breaks) {
  std::vector<LinePiece> out;
  bool space = true;   // start of the text: also the start of a line
  bool joins = false;  // the next character belongs to the previous piece
  bool wide_before = false;
  while (!text.empty()) {
    const core::Utf8Character c = core::next_character(text);
    const std::string_view letter = text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
    if (letter == " ") {
      if (space) out.push_back({"", !out.empty()});  // each additional space is a piece of its own
      space = true;
      continue;
    }
    const bool wide = is_wide(c.code);
    const bool ends = breaks == LineBreaks::kAtWideCharacters && (wide || wide_before) && !joins &&
                      !closes(letter);
    if (space || out.empty() || ends) {
      out.push_back({std::string(letter), space && !out.empty()});
    } else {
      out.back().text += letter;
    }
    space = false;
    wide_before = wide;
    joins = opens(letter);
  }
  return out;
}

}  // namespace

std::size_t columns(std::string_view text) {
  std::size_t sum = 0;
  while (!text.empty()) {
    const core::Utf8Character c = core::next_character(text);
    sum += is_wide(c.code) ? 2 : 1;
    text.remove_prefix(c.bytes);
  }
  return sum;
}

std::string padded(std::string_view text, std::size_t width) {
  const std::size_t taken = columns(text);
  return std::string(text) + std::string(taken < width ? width - taken : 0, ' ');
}

std::string shortened(std::string_view text, std::size_t limit) {
  if (columns(text) <= limit) return std::string(text);
  std::string result;
  std::size_t used = 3;
  while (!text.empty()) {
    const core::Utf8Character c = core::next_character(text);
    used += is_wide(c.code) ? 2 : 1;
    if (used > limit) break;
    result += text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
  }
  return result + "...";
}

std::string wrapped(std::string_view head, std::string_view text, LineBreaks breaks) {
  const std::size_t indent = columns(head);
  std::string out;
  std::string line(head);
  bool fresh = true;
  for (const LinePiece& piece : line_pieces(core::printable(text), breaks)) {
    const std::string word = shortened(piece.text, kTerminalColumns - indent);
    const std::size_t space = piece.after_space && !fresh ? 1 : 0;
    if (!fresh && columns(line) + space + columns(word) > kTerminalColumns) {
      out += line + "\n";
      line = std::string(indent, ' ');
      fresh = true;
    }
    line += (piece.after_space && !fresh ? " " : "") + word;
    fresh = false;
  }
  return out + line + "\n";
}

}  // namespace rondure::reports
