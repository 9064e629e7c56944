#include "plans/schema/utf8.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/utf8.h"

namespace rondure::plans {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

bool is_unshowable(const core::Utf8Character& c) {
  const bool control = core::is_control(c.code) && c.code != '\n' && c.code != '\t';
  return !c.valid || control || core::is_noncharacter(c.code);
}

template <class Bad>
std::size_t first_where(std::string_view text, const Bad& bad) {
  std::size_t i = 0;
  while (i < text.size()) {
    const core::Utf8Character c = core::next_character(text.substr(i));
    if (bad(c)) return i;
    i += c.bytes;
  }
  return text.size();
}

}  // namespace

std::size_t first_unshowable(std::string_view text) { return first_where(text, is_unshowable); }

std::string unshowable_in_words(std::string_view text, std::size_t index) {
  const core::Utf8Character c = core::next_character(text.substr(index));
  if (!c.valid) return fmt::format("the byte 0x{:02X}", static_cast<unsigned char>(text[index]));
  return fmt::format("the character U+{:04X}", c.code);
}

std::optional<std::string> fault_of_name(std::string_view text) {
  constexpr std::size_t kMostCharacters = 200;
  constexpr std::uint32_t kNonJoiner = 0x200C;  // letters of Persian and of Indic scripts need both
  constexpr std::uint32_t kJoiner = 0x200D;
  const std::size_t at = first_where(text, [](const core::Utf8Character& c) {
    return is_unshowable(c) || c.code == '\n' || c.code == '\t' ||
           (core::is_layout_mark(c.code) && c.code != kNonJoiner && c.code != kJoiner);
  });
  if (at < text.size()) {
    return fmt::format("contains {}, which no report can show in a line; remove it",
                       unshowable_in_words(text, at));
  }
  const std::size_t count = characters(text);
  if (count <= kMostCharacters) return std::nullopt;
  return fmt::format("has {} characters, the limit is {}; shorten it", count, kMostCharacters);
}

std::string escaped_line(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const core::Utf8Character c = core::next_character(text);
    if (!c.valid) {
      out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
    } else if (c.code == '\n') {
      out += "\\n";
    } else if (c.code == '\t' || is_unshowable(c)) {
      out += fmt::format("\\u{:04x}", c.code);
    } else {
      out += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return out;
}

std::size_t first_not_utf8(std::string_view text) {
  return first_where(text, [](const core::Utf8Character& c) { return !c.valid; });
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues(c); }));
}

std::string_view head_of(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && continues(text[bytes])) --bytes;
  return text.substr(0, bytes);
}

}  // namespace rondure::plans
