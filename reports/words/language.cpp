#include "reports/words/language.h"

#include <algorithm>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "reports/words/internal/sentence_format.h"
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
      if (line.context.empty()) out.insert_or_assign(line.english, line.chinese);
      if (line.context == Translation::kSentence) out.emplace(line.english, line.chinese);
    }
    return out;
  }();
  return all;
}

/// A format in both languages.
struct TwoFormats {
  SentenceFormat english;
  SentenceFormat chinese;
};

/// The formats of sentences, those with the most fixed text first: the most specific one counts.
const std::vector<TwoFormats>& sentences() {
  static const auto all = [] {
    std::vector<TwoFormats> out;
    for (const Translation& line : chinese_texts()) {
      if (line.context != Translation::kSentence) continue;
      if (line.english.find('{') == std::string_view::npos) continue;
      out.push_back({SentenceFormat(line.english), SentenceFormat(line.chinese)});
    }
    std::stable_sort(out.begin(), out.end(), [](const TwoFormats& a, const TwoFormats& b) {
      return a.english.letters() > b.english.letters();
    });
    return out;
  }();
  return all;
}

/// The parts of a list in its order, each translated.
std::optional<std::string> told_list(std::string_view english, std::string_view separator,
                                     std::string_view chinese_separator) {
  std::string out;
  for (;;) {
    const std::size_t end = english.find(separator);
    const auto part = told(english.substr(0, end));
    if (!part) return std::nullopt;
    out += *part;
    if (end == std::string_view::npos) return out;
    out += chinese_separator;
    english.remove_prefix(end + separator.size());
  }
}

/// One format with its arguments translated; none where one of them is not known.
std::optional<std::string> filled(const TwoFormats& format, std::string_view english) {
  auto arguments = format.english.arguments_of(english);
  if (!arguments) return std::nullopt;
  for (std::size_t i = 0; i < arguments->size(); ++i) {
    if (format.chinese.stays(i)) continue;
    auto in_words = told((*arguments)[i]);
    if (!in_words) return std::nullopt;
    (*arguments)[i] = *std::move(in_words);
  }
  return format.chinese.with(*arguments);
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

std::optional<std::string> told(std::string_view english) {
  if (the_language == Language::kEnglish || has_no_words(english)) return std::string(english);
  if (const auto found = table().find(english); found != table().end()) {
    return std::string(found->second);
  }
  for (const TwoFormats& format : sentences()) {
    if (auto out = filled(format, english)) return out;
  }
  if (english.find("; ") != std::string_view::npos) return told_list(english, "; ", "；");
  if (english.find(", ") != std::string_view::npos) return told_list(english, ", ", "，");
  return std::nullopt;
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
