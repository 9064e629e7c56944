#include "plans/schema/utf8.h"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace rondure::plans {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

bool continues(unsigned byte) { return (byte & 0xC0U) == 0x80U; }

// Length of the character that starts at i, 0 when it is malformed: overlong forms, surrogates and
// code points above U+10FFFF are excluded by the limits of the second byte.
std::size_t character_length(std::string_view text, std::size_t i) {
  const unsigned first = byte_at(text, i);
  const unsigned second = byte_at(text, i + 1);
  if (first < 0x80U) return 1;
  if (first < 0xC2U || first > 0xF4U || !continues(second)) return 0;
  if (first < 0xE0U) return 2;
  if ((first == 0xE0U && second < 0xA0U) || (first == 0xEDU && second > 0x9FU)) return 0;
  if (!continues(byte_at(text, i + 2))) return 0;
  if (first < 0xF0U) return 3;
  if ((first == 0xF0U && second < 0x90U) || (first == 0xF4U && second > 0x8FU)) return 0;
  return continues(byte_at(text, i + 3)) ? 4 : 0;
}

// The code point of `length` bytes at i.
std::uint32_t code_at(std::string_view text, std::size_t i, std::size_t length) {
  std::uint32_t code = length == 1 ? byte_at(text, i) : byte_at(text, i) & (0xFFU >> (length + 1));
  for (std::size_t k = 1; k < length; ++k) code = code << 6U | (byte_at(text, i + k) & 0x3FU);
  return code;
}

bool is_unshowable(std::uint32_t code) {
  const bool control =
      (code < 0x20U && code != '\n' && code != '\t') || (code >= 0x7FU && code < 0xA0U);
  return control || (code >= 0xFDD0U && code <= 0xFDEFU) || (code & 0xFFFEU) == 0xFFFEU;
}

}  // namespace

std::size_t first_unshowable(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t length = character_length(text, i);
    if (length == 0 || is_unshowable(code_at(text, i, length))) return i;
    i += length;
  }
  return text.size();
}

std::string unshowable_in_words(std::string_view text, std::size_t index) {
  const std::size_t length = character_length(text, index);
  if (length == 0) return fmt::format("the byte 0x{:02X}", byte_at(text, index));
  return fmt::format("the character U+{:04X}", code_at(text, index, length));
}

std::string escaped_line(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = std::max<std::size_t>(character_length(text, i), 1);
    const std::uint32_t code = code_at(text, i, length);
    if (character_length(text, i) == 0) {
      out += fmt::format("\\x{:02x}", code);
    } else if (code == '\n') {
      out += "\\n";
    } else if (code == '\t' || is_unshowable(code)) {
      out += fmt::format("\\u{:04x}", code);
    } else {
      out += text.substr(i, length);
    }
    i += length;
  }
  return out;
}

std::size_t first_not_utf8(std::string_view text) {
  std::size_t i = 0;
  while (i < text.size()) {
    const std::size_t length = character_length(text, i);
    if (length == 0) return i;
    i += length;
  }
  return text.size();
}

std::size_t characters(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return !continues(static_cast<unsigned char>(c)); }));
}

std::string_view head_of(std::string_view text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && continues(byte_at(text, bytes))) --bytes;
  return text.substr(0, bytes);
}

}  // namespace rondure::plans
