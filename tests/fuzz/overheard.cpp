#include "tests/fuzz/overheard.h"

#include <cctype>

#include <fmt/format.h>

#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/utf8.h"
#include "plans/schema/utf8.h"

namespace rondure {
namespace {

std::string g_said;
std::string g_told;

/// A word of fmt or of C for a number that is none, standing alone.
bool has_word(const std::string& text, const std::string& word) {
  const auto letter = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 ||
                               text[i] == '_' || text[i] == '"');
  };
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if (!(at > 0 && letter(at - 1)) && !letter(at + word.size())) return true;
  }
  return false;
}

}  // namespace

// In place of app/text/terminal.cpp: nothing is printed.
namespace app {

void say(std::string_view text) { g_said += text; }
void say_line(std::string_view line) { g_said += core::printable(line) + "\n"; }
void tell(std::string_view line) { g_told += core::printable(line); }
void print_error(const core::Error& error) { tell(core::to_line(error)); }
void print_error(const std::vector<core::Error>& errors) {
  for (const core::Error& error : errors) print_error(error);
}
bool stop_requested() { return false; }

}  // namespace app

namespace fuzz {
namespace {

std::string wrong_with_words(const std::string& text) {
  if (plans::first_not_utf8(text) != text.size()) return "not UTF-8: " + text.substr(0, 400);
  for (const char* word : {"nan", "inf", "-nan", "-inf"}) {
    if (has_word(text, word)) return fmt::format("it says {}: {}", word, text.substr(0, 2000));
  }
  return {};
}

}  // namespace

std::string wrong_with_text(const std::string& text) {
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\t' && c != '\r') || c == 127) {
      return fmt::format("control character {:#04x}: {}", static_cast<int>(c), text.substr(0, 400));
    }
  }
  return wrong_with_words(text);
}

std::string wrong_with_answer(const std::function<int()>& verb) {
  g_said.clear();
  g_told.clear();
  const int status = verb();
  if (auto wrong = wrong_with_words(g_said); !wrong.empty()) return "result: " + wrong;
  if (auto wrong = wrong_with_words(g_told); !wrong.empty()) return "sentence: " + wrong;
  if (status == app::kAllWell || status == app::kNotConforming) {
    return g_said.empty() ? "no result" : "";
  }
  if (status != app::kBadInput) return fmt::format("exit status {}", status);
  return g_told.empty() ? "refused without a word" : "";
}

}  // namespace fuzz
}  // namespace rondure
