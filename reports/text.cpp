#include "reports/text.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "core/units.h"
#include "reports/words/language.h"

namespace rondure::reports {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// One character of UTF-8 text; a byte that starts none is a character by itself.
struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
  bool valid = true;
};

Character next_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return {first, 1, true};
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < length) return {0, 1, false};
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {0, 1, false};
    code = (code << 6U) | (byte(i) & 0x3FU);
  }
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  const bool overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  if (surrogate || overlong || code > 0x10FFFF) return {0, 1, false};
  return {code, length, true};
}

bool is_control(std::uint32_t code) { return code < 0x20 || (code >= 0x7F && code < 0xA0); }

/// Codes that are no characters: XML and HTML refuse them.
bool is_noncharacter(std::uint32_t code) {
  return (code >= 0xFDD0 && code <= 0xFDEF) || (code & 0xFFFEU) == 0xFFFE;
}

/// Marks that reorder what follows, or line and paragraph separators.
bool is_layout_mark(std::uint32_t code) {
  return code == 0x061C || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x2028 && code <= 0x202E) || (code >= 0x2060 && code <= 0x2069) || code == 0xFEFF;
}

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

/// Punctuation that no line begins with, and that none ends with.
bool closes(std::string_view letter) {
  constexpr std::string_view kMarks = "，。；：、）》”！？·%)],.;:";
  return kMarks.find(letter) != std::string_view::npos;
}
bool opens(std::string_view letter) {
  constexpr std::string_view kMarks = "（《“([";
  return kMarks.find(letter) != std::string_view::npos;
}

}  // namespace

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\xE2\x80\x93";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string um(double length_mm) {
  return fixed(length_mm / core::kMicrometre, std::abs(length_mm) < 1.0 ? 3 : 1);
}

std::string signed_um(double length_mm) {
  std::string text = um(length_mm);
  return text.front() == '-' || !std::isfinite(length_mm) ? text : text.insert(0, 1, '+');
}

std::string f_um(double f_mm) {
  return fixed(f_mm / core::kMicrometre, std::abs(f_mm) > 0.1 ? 2 : 3);
}

std::string tiny_um(double length_mm) {
  return fmt::format("{:.2g}", length_mm / core::kMicrometre);
}

std::string deg(double angle_rad, int decimals) {
  return fixed(angle_rad / core::kDegree, decimals);
}

std::string count(std::size_t number, std::string_view one, std::string_view many) {
  if (language() != Language::kEnglish) return fmt::format("{} {}", number, tr(many));
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

std::string capitalised(std::string_view text) {
  std::string result(text);
  if (!result.empty() && result.front() >= 'a' && result.front() <= 'z') {
    result.front() = static_cast<char>(result.front() - 'a' + 'A');
  }
  return result;
}

std::string well_formed(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character c = next_character(text);
    result += c.valid && c.code != 0 ? text.substr(0, c.bytes) : kReplacement;
    text.remove_prefix(c.bytes);
  }
  return result;
}

std::string clean(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character c = next_character(text);
    const bool refused =
        (is_control(c.code) && c.code != '\n' && c.code != '\t') || is_noncharacter(c.code);
    result += c.valid && !refused ? text.substr(0, c.bytes) : kReplacement;
    text.remove_prefix(c.bytes);
  }
  return result;
}

std::string decimal(double value) {
  std::array<char, 1100> digits{};  // the longest double has 1 + 309 or 1 + 1 + 1074 of them
  const auto [end, problem] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  if (problem != std::errc()) return "0";
  const std::string text(digits.data(), end);
  return text == "-0" ? "0" : text;
}

std::string escaped(std::string_view text) {
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  while (!text.empty()) {
    const Character c = next_character(text);
    if (!c.valid || is_noncharacter(c.code) ||
        (is_control(c.code) && c.code != '\n' && c.code != '\t')) {
      result += kReplacement;
    } else if (c.code == '&') {
      result += "&amp;";
    } else if (c.code == '<') {
      result += "&lt;";
    } else if (c.code == '>') {
      result += "&gt;";
    } else if (c.code == '"') {
      result += "&quot;";
    } else if (c.code == '\'') {
      result += "&#39;";
    } else {
      result += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return result;
}

std::string isolated(std::string_view text) { return fmt::format("<bdi>{}</bdi>", escaped(text)); }

namespace {

/// " um" and " degC" with their signs.
std::string with_signs(std::string_view text) {
  std::string out(text);
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto replace = [&](std::string_view from, std::string_view to) {
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at + 1)) {
      const std::size_t end = at + from.size();
      if (end == out.size() || !letter(out[end])) out.replace(at, from.size(), to);
    }
  };
  replace(" um", " \u00b5m");
  replace(" degC", " \u00b0C");
  return out;
}

}  // namespace

std::string foreign(std::string_view text) {
  if (language() == Language::kEnglish) return isolated(text);
  return fmt::format(R"(<bdi lang="en">{}</bdi>)", escaped(text));
}

std::string worded(std::string_view text) {
  const auto known = told(text);
  return known ? isolated(*known) : foreign(text);
}

std::string plain_words(std::string_view text) {
  const auto known = told(text);
  return known ? escaped(*known) : foreign(text);
}

std::string in_sentence(std::string_view text) { return in_sentence(told(text), text); }

std::string in_sentence(const std::optional<std::string>& words, std::string_view english) {
  return words ? isolated(with_signs(*words)) : foreign(with_signs(english));
}

std::string opening_sentence(std::string_view text) {
  const auto known = told(text);
  return known ? isolated(with_signs(capitalised(*known))) : foreign(with_signs(capitalised(text)));
}

std::string titled(core::Code code) {
  const std::string title = title_of(code);
  return title.empty() ? title : title + "：";
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const Character c = next_character(text);
    if (!c.valid || is_control(c.code) || is_noncharacter(c.code) || is_layout_mark(c.code)) {
      result += '?';
    } else {
      result += text.substr(0, c.bytes);
    }
    text.remove_prefix(c.bytes);
  }
  return result;
}

std::size_t columns(std::string_view text) {
  std::size_t sum = 0;
  while (!text.empty()) {
    const Character c = next_character(text);
    sum += is_wide(c.code) ? 2 : 1;
    text.remove_prefix(c.bytes);
  }
  return sum;
}

std::string padded(std::string_view text, std::size_t width) {
  const std::size_t taken = columns(text);
  return std::string(text) + std::string(taken < width ? width - taken : 0, ' ');
}

std::vector<LinePiece> line_pieces(std::string_view text) {
  std::vector<LinePiece> out;
  bool space = true;   // the text begins a line
  bool joins = false;  // the next character belongs to the piece before it
  bool wide_before = false;
  while (!text.empty()) {
    const Character c = next_character(text);
    const std::string_view letter = text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
    if (letter == " ") {
      if (space) out.push_back({"", !out.empty()});  // each space more stands for itself
      space = true;
      continue;
    }
    const bool wide = is_wide(c.code);
    const bool breaks = (wide || wide_before) && !joins && !closes(letter);
    if (space || out.empty() || breaks) {
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

std::string shortened(std::string_view text, std::size_t limit) {
  if (columns(text) <= limit) return std::string(text);
  std::string result;
  std::size_t used = 3;
  while (!text.empty()) {
    const Character c = next_character(text);
    used += is_wide(c.code) ? 2 : 1;
    if (used > limit) break;
    result += text.substr(0, c.bytes);
    text.remove_prefix(c.bytes);
  }
  return result + "...";
}

}  // namespace rondure::reports
