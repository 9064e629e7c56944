#include "reports/words/language.h"

#include <unordered_map>
#include <utility>
#include <variant>

#include "reports/words/internal/zh.h"

namespace rondure::reports {
namespace {

thread_local Language the_language = Language::kEnglish;

using Table = std::unordered_map<std::string_view, std::string_view>;

/// The texts of the catalogue by the English text, except the titles of codes. Where a text is also
/// a sentence, the entry for tr() counts: it may state how its arguments are written.
const Table& table() {
  static const Table all = [] {
    Table out;
    for (const Translation& line : chinese_texts()) {
      if (line.context.empty()) out.emplace(line.english, line.chinese);
    }
    return out;
  }();
  return all;
}

}  // namespace

std::optional<Language> language_named(std::string_view name) {
  if (name == "en") return Language::kEnglish;
  if (name == "zh") return Language::kChinese;
  return std::nullopt;
}

std::vector<std::string> language_names() { return {"en", "zh"}; }

std::string_view tag_of(Language language) {
  return language == Language::kChinese ? "zh-Hans" : "en";
}

LanguageScope::LanguageScope(Language language) : before_(std::exchange(the_language, language)) {}

LanguageScope::~LanguageScope() { the_language = before_; }

Language language() { return the_language; }

std::string tr(std::string_view english) {
  if (the_language == Language::kEnglish) return std::string(english);
  const auto found = table().find(english);
  return std::string(found == table().end() ? english : found->second);
}

std::optional<std::string> in_words(const core::Phrase& phrase) {
  if (the_language == Language::kEnglish || phrase.empty()) return phrase.english();
  const auto found = table().find(phrase.format());
  if (found == table().end()) return std::nullopt;
  std::vector<core::Phrase::Argument> arguments = phrase.arguments();
  for (core::Phrase::Argument& argument : arguments) {
    const auto* part = std::get_if<core::Phrase>(&argument.value);
    if (part == nullptr) continue;
    const auto words = in_words(*part);
    if (!words) return std::nullopt;
    argument = core::Phrase::Argument(*words);
  }
  return core::filled(found->second, arguments);
}

std::string title_of(core::Code code) {
  if (the_language == Language::kEnglish) return {};
  for (const Translation& line : chinese_texts()) {
    if (line.context == Translation::kCode && line.english == core::code_name(code)) {
      return std::string(line.chinese);
    }
  }
  return {};
}

std::string count(std::size_t number, std::string_view one, std::string_view many) {
  if (language() != Language::kEnglish) return fmt::format("{} {}", number, tr(many));
  return fmt::format("{} {}", number, number == 1 ? one : many);
}

std::string capitalised(std::string_view text) {
  std::string result(text);
  if (!result.empty() && result.front() >= 'a' && result.front() <= 'z') {
    result.front() = static_cast<char>(result.front() - 'a' + 'A');
  }
  return result;
}

}  // namespace rondure::reports
