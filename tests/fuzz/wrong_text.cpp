#include "tests/fuzz/wrong_text.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

#include <fmt/format.h>

#include "core/encodings.h"
#include "plans/schema/json_text.h"

namespace rondure::fuzz {
namespace {

/// Where a word of fmt or of C for a number that is none stands alone; npos if nowhere.
std::size_t place_of(const std::string& word, const std::string& text) {
  const auto letter = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 ||
                               text[i] == '_' || text[i] == '"');
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (!(at > 0 && letter(at - 1)) && !letter(at + word.size())) return at;
  }
  return std::string::npos;
}

std::string wrong_with_bytes(const std::string& text) {
  if (plans::first_not_utf8(text) != text.size()) return "not UTF-8: " + text.substr(0, 400);
  return {};
}

std::string wrong_with_controls(const std::string& text) {
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\t' && c != '\r') || c == 127) {
      return fmt::format("control character {:#04x}: {}", static_cast<int>(c), text.substr(0, 400));
    }
  }
  return {};
}

}  // namespace

std::string wrong_with_words(const std::string& text) {
  if (auto wrong = wrong_with_bytes(text); !wrong.empty()) return wrong;
  for (const char* word : {"nan", "inf", "-nan", "-inf"}) {
    if (const std::size_t at = place_of(word, text); at != std::string::npos) {
      return fmt::format("it says {}: ...{}", word,
                         text.substr(at - std::min<std::size_t>(at, 300), 600));
    }
  }
  return {};
}

std::string wrong_with_text(const std::string& text) {
  if (auto wrong = wrong_with_controls(text); !wrong.empty()) return wrong;
  return wrong_with_words(text);
}

std::string wrong_with_refusal(const core::Error& refusal) {
  if (refusal.what.empty()) return "refused without a word";
  const std::string line = core::printable(core::to_line(refusal));
  if (auto wrong = wrong_with_controls(line); !wrong.empty()) return wrong;
  return wrong_with_bytes(line);
}

}  // namespace rondure::fuzz
