#pragma once

#include <string_view>

namespace rondure::reports::testing {

/// "nan" as a word, not as a part of one ("Provenance").
inline bool shows_nan(std::string_view page) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (std::size_t at = page.find("nan"); at != std::string_view::npos;
       at = page.find("nan", at + 1)) {
    if (at > 0 && at + 3 < page.size() && !letter(page[at - 1]) && !letter(page[at + 3]))
      return true;
  }
  return false;
}

}  // namespace rondure::reports::testing
