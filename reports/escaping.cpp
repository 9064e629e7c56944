#include "reports/escaping.h"

#include <array>

#include <fmt/format.h>

#include "core/encodings.h"
#include "reports/words/language.h"

namespace rondure::reports {

std::string clean(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const core::Utf8Character c = core::next_character(text);
    const bool refused = (core::is_control(c.code) && c.code != '\n' && c.code != '\t') ||
                         core::is_noncharacter(c.code);
    result += c.valid && !refused ? text.substr(0, c.bytes) : core::kReplacement;
    text.remove_prefix(c.bytes);
  }
  return result;
}

std::string csv_field(std::string_view name) {
  std::string text = clean(name);
  if (!text.empty() && std::string_view("=+-@\t\r").find(text.front()) != std::string_view::npos) {
    text.insert(text.begin(), '\'');
  }
  if (text.find_first_of(",;\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + "\"";
}

std::string escaped(std::string_view text) {
  constexpr std::string_view kMarkup = "&<>\"'";
  constexpr std::array<std::string_view, 5> kEntities = {"&amp;", "&lt;", "&gt;", "&quot;",
                                                         "&#39;"};
  std::string result;
  result.reserve(text.size() + text.size() / 8);
  for (const char c : clean(text)) {
    const std::size_t at = kMarkup.find(c);
    if (at == std::string_view::npos) {
      result += c;
    } else {
      result += kEntities[at];
    }
  }
  return result;
}

std::string isolated(std::string_view text) { return fmt::format("<bdi>{}</bdi>", escaped(text)); }

std::string with_signs(std::string_view text) {
  std::string out(text);
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto replace = [&](std::string_view from, std::string_view to) {
    for (std::size_t at = out.find(from); at != std::string::npos; at = out.find(from, at + 1)) {
      const std::size_t end = at + from.size();
      if (end == out.size() || !letter(out[end])) out.replace(at, from.size(), to);
    }
  };
  replace(" um", " \u00b5m");
  replace(" degC", " \u00b0C");
  return out;
}

std::string foreign(std::string_view text) {
  if (language() == Language::kEnglish) return isolated(text);
  return fmt::format(R"(<bdi lang="en">{}</bdi>)", escaped(text));
}

std::string worded(const core::Phrase& phrase) {
  const auto known = in_words(phrase);
  return known ? isolated(*known) : foreign(phrase.english());
}

std::string plain_words(const core::Phrase& phrase) {
  const auto known = in_words(phrase);
  return known ? escaped(*known) : foreign(phrase.english());
}

std::string in_sentence(const core::Phrase& phrase) {
  return in_sentence(in_words(phrase), phrase.english());
}

std::string in_sentence(const std::optional<std::string>& words, std::string_view english) {
  return words ? isolated(with_signs(*words)) : foreign(with_signs(english));
}

std::string opening_sentence(const core::Phrase& phrase) {
  const auto known = in_words(phrase);
  return known ? isolated(with_signs(capitalised(*known)))
               : foreign(with_signs(capitalised(phrase.english())));
}

std::string titled(core::Code code) {
  const std::string title = title_of(code);
  return title.empty() ? title : title + "：";
}

}  // namespace rondure::reports
