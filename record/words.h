#pragma once

#include <optional>
#include <string_view>
#include <type_traits>

#include "core/words.h"

namespace rondure::record {

// The order of words is that in which the schema and the messages of plans list them.

/// An enum with the function words_of(Enum).
template <class Enum>
concept Worded = std::is_enum_v<Enum> && requires(Enum value) {
  words_of(value);
};

/// The spelling of a value.
template <Worded Enum>
[[nodiscard]] constexpr std::string_view name_of(Enum value) {
  return core::word_for(words_of(value), value);
}

/// The value with that spelling; nothing for an unknown word.
template <Worded Enum>
[[nodiscard]] constexpr std::optional<Enum> value_named(std::string_view text) {
  for (const auto& word : words_of(Enum{})) {
    if (word.text == text) return word.value;
  }
  return std::nullopt;
}

/// A format of the files that are derived from a record.
enum class Format { kHtml, kPdf, kJson, kCsv, kQif, kDmis, kCorrections };

/// Paper of report.pdf.
enum class Paper { kA4, kLetter };

RONDURE_WORDS(Format, {kHtml, "html"}, {kPdf, "pdf"}, {kJson, "json"}, {kCsv, "csv"}, {kQif, "qif"},
              {kDmis, "dmis"}, {kCorrections, "corrections"});
RONDURE_WORDS(Paper, {kA4, "a4"}, {kLetter, "letter"});

/// A setting that is on or off.
enum class Switch { kOff, kOn };

RONDURE_WORDS(Switch, {kOff, "off"}, {kOn, "on"});

}  // namespace rondure::record
