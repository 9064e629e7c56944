#pragma once

#include <string>
#include <string_view>

#include "reports/escaping.h"

namespace rondure::reports {

/// A text as a field by RFC 4180: quoted when it holds a comma, a quote or a line break; control
/// characters are U+FFFD. A text that a spreadsheet would compute (it begins with = + - @ or a tab)
/// gets an apostrophe in front, which tells spreadsheets that it is text. Not for numbers.
[[nodiscard]] inline std::string csv_field(std::string_view text) {
  std::string plain = clean(text);
  if (!plain.empty() && std::string_view("=+-@\t").find(plain.front()) != std::string_view::npos) {
    plain.insert(plain.begin(), '\'');
  }
  if (plain.find_first_of(",\"\n") == std::string::npos) return plain;
  std::string quoted = "\"";
  for (const char c : plain) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace rondure::reports
