#include "core/json_text.h"

#include <algorithm>

#include <fmt/format.h>

namespace rondure::core {

Result<void> check_json(std::string_view text, std::string_view name) {
  if (text.size() > kMostJsonBytes) {
    return fail(
        Code::kSyntax,
        fmt::format("the text has {} bytes, the limit for JSON is {}", text.size(), kMostJsonBytes),
        std::string(name));
  }
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      quoted = c != '"';
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth <= kDeepestJson) continue;
      return fail(Code::kSyntax,
                  fmt::format("the text is nested deeper than {} levels, from byte {} on",
                              kDeepestJson, i + 1),
                  std::string(name));
    } else if (c == ']' || c == '}') {
      if (depth > 0) --depth;
    }
  }
  return {};
}

Error json_fault(std::string_view text, std::size_t byte, std::string_view name) {
  return {
      Code::kSyntax,
      fmt::format("the text is no JSON from byte {} of {} on; the file is cut off or was edited",
                  std::min(byte, text.size()), text.size()),
      std::string(name)};
}

}  // namespace rondure::core
