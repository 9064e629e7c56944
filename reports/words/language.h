#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/phrase.h"

namespace rondure::reports {

/// Languages of the reports for people: the page and the terminal's summary. The formats for
/// programs (JSON, CSV, QIF, DMIS) are always English.
enum class Language { kEnglish, kChinese };

/// "en" or "zh"; nothing for any other name.
[[nodiscard]] std::optional<Language> language_named(std::string_view name);
/// All names that language_named() accepts.
[[nodiscard]] std::vector<std::string> language_names();
/// "en", "zh-Hans": the tag of BCP 47, as <html lang="..."> states it.
[[nodiscard]] std::string_view tag_of(Language language);

/// The language of the report that is being written, for the lifetime of this object.
///
/// Only the entry point of a writer sets it, from its argument: a writer stays a pure function of
/// record and language. The language is stored per thread instead of being passed through the
/// signatures of a hundred helpers (drawings, captions, words for a reference) that need it for one
/// label each. Writers on several threads do not interfere. Outside a writer everything is English:
/// evaluation, journal and the formats for programs.
class LanguageScope {
 public:
  explicit LanguageScope(Language language);
  LanguageScope(const LanguageScope&) = delete;
  LanguageScope& operator=(const LanguageScope&) = delete;
  ~LanguageScope();

 private:
  Language before_;
};

/// The language of the report that this thread is writing.
[[nodiscard]] Language language();

/// Marks a text of a table that tr() will translate; returns it unchanged.
[[nodiscard]] constexpr const char* translatable(const char* english) { return english; }

/// The text in the language of the report; English where the table has none. The English text is
/// the key of the catalogue zh.po. A test checks that each literal passed here is in it.
[[nodiscard]] std::string tr(std::string_view english);

/// The same for a format text, with its arguments. The Chinese text may use them in another order:
/// trf("{} of {} layers", 2, 5) has "{1} 层中的 {0} 层". The compiler checks the English format, a
/// test the Chinese one against it.
template <class... Args>
[[nodiscard]] std::string trf(fmt::format_string<Args...> english, Args&&... args) {
  const fmt::string_view key = english;
  return fmt::vformat(tr(std::string_view(key.data(), key.size())), fmt::make_format_args(args...));
}

/// "1 touch", "3 touches": the number with the singular or plural word; in Chinese the word for
/// `many`.
[[nodiscard]] std::string count(std::size_t number, std::string_view one, std::string_view many);

/// The text with the first letter in upper case (ASCII).
[[nodiscard]] std::string capitalised(std::string_view text);

/// A sentence that another room made as data, in the language of the report. Nothing where the
/// catalogue lacks it or a part of it (a text of a machine or of a journal): the report then
/// shows the English one and says that it is English.
[[nodiscard]] std::optional<std::string> in_words(const core::Phrase& phrase);

/// Meaning of a code, as the title of an error or a warning: "点太少". Empty in English, where the
/// sentence states it.
[[nodiscard]] std::string title_of(core::Code code);

}  // namespace rondure::reports
