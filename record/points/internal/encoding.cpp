#include "record/points/internal/encoding.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "core/utf8.h"
#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

void append(std::uint32_t code, std::string& out) {
  const auto add = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  if (code < 0x80) return add(code);
  if (code < 0x800) {
    add(0xC0U | (code >> 6U));
  } else {
    if (code < 0x10000) {
      add(0xE0U | (code >> 12U));
    } else {
      add(0xF0U | (code >> 18U));
      add(0x80U | ((code >> 12U) & 0x3FU));
    }
    add(0x80U | ((code >> 6U) & 0x3FU));
  }
  add(0x80U | (code & 0x3FU));
}

std::string from_utf16(std::string_view bytes, bool little) {
  std::string out;
  out.reserve(bytes.size() / 2);
  const auto unit = [&](std::size_t i) -> std::uint32_t {
    const auto low = static_cast<unsigned char>(bytes[little ? i : i + 1]);
    const auto high = static_cast<unsigned char>(bytes[little ? i + 1 : i]);
    return low | (std::uint32_t{high} << 8U);
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800 && code < 0xE000) {
      const std::uint32_t low = code < 0xDC00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
      const bool pair = low >= 0xDC00 && low < 0xE000;
      code = pair ? 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00) : 0xFFFD;
      if (pair) i += 2;
    }
    append(code, out);
  }
  return out;
}

std::string from_windows_1252(std::string_view bytes) {
  constexpr std::array<std::uint16_t, 32> kUpper = {
      0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
      0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD, 0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
      0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};
  std::string out;
  out.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    append(byte >= 0x80 && byte < 0xA0 ? kUpper.at(byte - 0x80U) : byte, out);
  }
  return out;
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    std::uint64_t eight = 0;
    if (text.size() >= sizeof(eight)) {
      std::memcpy(&eight, text.data(), sizeof(eight));
      if ((eight & 0x8080808080808080U) == 0) {
        text.remove_prefix(sizeof(eight));
        continue;
      }
    }
    const core::Utf8Character c = core::next_character(text);
    if (!c.valid) return false;
    text.remove_prefix(c.bytes);
  }
  return true;
}

}  // namespace

std::string_view DecodedText::text(std::string_view bytes) const {
  return encoding.empty() ? without_byte_order_mark(bytes) : converted;
}

core::Result<DecodedText> decode_text(std::string_view bytes, std::string_view name) {
  using namespace std::string_view_literals;
  if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv)) {
    return core::fail(core::Code::kSyntax, "the file is saved as UTF-32; save it as UTF-8",
                      fmt::format("{}:1", name));
  }
  const std::string_view begin = bytes.substr(0, 4096);
  std::array<std::size_t, 2> zeros = {};  // at even and at odd places
  for (std::size_t i = 0; i < begin.size(); ++i) zeros.at(i % 2) += begin[i] == '\0' ? 1 : 0;
  const bool marked = is_utf16(bytes);
  if (marked || 4 * (zeros[0] + zeros[1]) > begin.size()) {
    const bool little = marked ? bytes.starts_with('\xff') : zeros[1] > zeros[0];
    std::string text = from_utf16(bytes.substr(marked ? 2 : 0), little);
    if (text.find('\0') == std::string::npos) {
      return DecodedText{std::move(text), little ? "UTF-16 LE"sv : "UTF-16 BE"sv};
    }
  }
  if (const std::size_t zero = bytes.find('\0'); zero != std::string_view::npos) {
    const auto line = 1 + std::ranges::count(bytes.substr(0, zero), '\n');
    return core::fail(core::Code::kSyntax,
                      "the line holds a NUL byte; plain text is expected, saved as UTF-8",
                      fmt::format("{}:{}", name, line));
  }
  if (is_utf8(bytes)) return DecodedText{};
  return DecodedText{from_windows_1252(bytes), "Windows-1252"};
}

}  // namespace rondure::record
