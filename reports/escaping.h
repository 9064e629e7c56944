#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/phrase.h"

namespace rondure::reports {

/// Text that any file format can hold: well-formed UTF-8 without control characters (except line
/// feed and tab) and without the noncharacters that XML and HTML refuse; each of these becomes
/// U+FFFD.
[[nodiscard]] std::string clean(std::string_view text);

/// A text as a field by RFC 4180, clean(): quoted when it holds a comma, a semicolon (which
/// separates fields where a comma is the decimal mark), a quote or a line break. A text that a
/// spreadsheet would compute (it begins with = + - @, a tab or CR) gets an apostrophe in front,
/// which spreadsheets read as the start of text. Not for numbers.
[[nodiscard]] std::string csv_field(std::string_view text);

/// Escapes text for HTML, in elements and in quoted attributes: & < > " ' become entities, control
/// characters and noncharacters the replacement character.
[[nodiscard]] std::string escaped(std::string_view text);
/// escaped() and isolated (<bdi>), so that a right-to-left name does not reorder its neighbours.
[[nodiscard]] std::string isolated(std::string_view text);

/// The text with " um" and " degC" as signs: " µm", " °C".
[[nodiscard]] std::string with_signs(std::string_view text);

/// Text of the program that is English in every report (an error from another room, a device's
/// name): escaped, isolated and, in a report in another language, marked as English.
[[nodiscard]] std::string foreign(std::string_view text);
/// Words that evaluation or another room chose ("finished", "guided"), as in_words() has them, else
/// foreign().
[[nodiscard]] std::string worded(const core::Phrase& phrase);
/// The same, not isolated where the words are known: of words that no user can write.
[[nodiscard]] std::string plain_words(const core::Phrase& phrase);
/// worded() of a sentence, which spells units in ASCII: " um" and " degC" with their signs.
[[nodiscard]] std::string in_sentence(const core::Phrase& phrase);
/// The same of words that are known already, or of their English where they are not.
[[nodiscard]] std::string in_sentence(const std::optional<std::string>& words,
                                      std::string_view english);
/// in_sentence() that begins with an upper-case letter.
[[nodiscard]] std::string opening_sentence(const core::Phrase& phrase);
/// Title before the sentence of an error: the title of its code; empty in English.
[[nodiscard]] std::string titled(core::Code code);

}  // namespace rondure::reports
