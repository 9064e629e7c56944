#include "reports/words/internal/zh.h"

#include <cstddef>
#include <cstdint>

namespace rondure::reports {
namespace {

/// The number in the four bytes starting at `at`.
std::uint32_t number_at(std::size_t at) {
  const auto bytes = chinese_catalogue().subspan(at, 4);
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8U |
         static_cast<std::uint32_t>(bytes[2]) << 16U | static_cast<std::uint32_t>(bytes[3]) << 24U;
}

/// The text whose length and offset are stored at `at`.
std::string_view text_at(std::size_t at) {
  const auto bytes = chinese_catalogue().subspan(number_at(at + 4), number_at(at));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A .mo file is a count and two tables of texts: GNU gettext manual, "The Format of GNU MO Files".
std::vector<Translation> read_catalogue() {
  const std::size_t count = number_at(8);
  const std::size_t originals = number_at(12);
  const std::size_t translations = number_at(16);
  std::vector<Translation> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::string_view english = text_at(originals + 8 * i);
    std::string_view context;
    if (const std::size_t end = english.find('\4'); end != std::string_view::npos) {
      context = english.substr(0, end);
      english.remove_prefix(end + 1);
    }
    if (!english.empty()) out.push_back({context, english, text_at(translations + 8 * i)});
  }
  return out;
}

}  // namespace

const std::vector<Translation>& chinese_texts() {
  static const std::vector<Translation> all = read_catalogue();
  return all;
}

}  // namespace rondure::reports
