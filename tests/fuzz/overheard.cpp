#include "tests/fuzz/overheard.h"

#include <fmt/format.h>

#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/encodings.h"

namespace rondure {
namespace {

std::string g_said;
std::string g_told;

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
