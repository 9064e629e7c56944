#include "app/text/shell_word.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/utf8.h"

namespace rondure::app {
namespace {

/// $'a\x1bb', as bash, zsh and ksh read it: the command still names the file, and can be shown.
std::string with_escapes(const std::string& word) {
  std::string out = "$'";
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte >= 0x20 && byte < 0x7F && c != '\'' && c != '\\';
    out += plain ? std::string(1, c) : fmt::format("\\{:03o}", byte);
  }
  return out + "'";
}

}  // namespace

std::string quoted(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:@%=+,";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  const bool controls =
      std::any_of(word.begin(), word.end(), [](unsigned char c) { return c < 0x20 || c >= 0x7F; });
  if (controls && core::printable(word) != word) return with_escapes(word);
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace rondure::app
