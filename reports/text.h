#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/units.h"

namespace rondure::reports {

/// Columns of a line on a terminal.
inline constexpr std::size_t kTerminalColumns = 80;

inline constexpr double kMicroradian = 1e-6;  ///< in rad
/// A length in um, as a number.
[[nodiscard]] inline double micrometres(double length_mm) { return length_mm / core::kMicrometre; }

/// Numbers and names as reports print them. No locale, no clock: same value, same text. A value
/// that is not finite is an en dash, a rounded zero has no sign.
[[nodiscard]] std::string fixed(double value, int decimals);

/// A length in um: three decimals below 1 mm, one above.
[[nodiscard]] std::string um(double length_mm);
/// The same with its sign, also "+".
[[nodiscard]] std::string signed_um(double length_mm);
/// f of a pose in um: three decimals, two above 100 um.
[[nodiscard]] std::string f_um(double f_mm);
/// A very small length in um, two digits: "1.2e-09".
[[nodiscard]] std::string tiny_um(double length_mm);
/// An angle in degrees.
[[nodiscard]] std::string deg(double angle_rad, int decimals = 4);

/// "1 touch", "3 touches": the number and the word in its number; in Chinese the word of `many`.
[[nodiscard]] std::string count(std::size_t number, std::string_view one, std::string_view many);

/// The text with the first letter in upper case (ASCII).
[[nodiscard]] std::string capitalised(std::string_view text);

/// The text as well-formed UTF-8 without NUL; what is neither becomes U+FFFD.
[[nodiscard]] std::string well_formed(std::string_view text);

/// Text that any file format can hold: well-formed UTF-8 without control characters (line feed and
/// tab stay) and without noncharacters, which XML and HTML refuse; each of these becomes U+FFFD.
[[nodiscard]] std::string clean(std::string_view text);

/// The shortest decimal text, without an exponent, that reads back to the same double
/// ("0.0000001"). `value` must be finite.
[[nodiscard]] std::string decimal(double value);

/// Text that stays text in HTML, in elements and in quoted attributes: & < > " ' become entities,
/// control characters and noncharacters the replacement character.
[[nodiscard]] std::string escaped(std::string_view text);
/// Escaped and isolated (<bdi>), so that a right-to-left name does not reorder its neighbours.
[[nodiscard]] std::string isolated(std::string_view text);

/// Text of the program that is English whatever the language of the report (an error made in
/// another room, a device's name): escaped, isolated and, in a report that is not English, marked
/// as English.
[[nodiscard]] std::string foreign(std::string_view text);
/// Words that evaluation or another room chose ("finished", "guided"), as told() knows them, else
/// foreign().
[[nodiscard]] std::string worded(std::string_view text);
/// The same, not isolated where the words are known: of words that no user can write.
[[nodiscard]] std::string plain_words(std::string_view text);
/// worded() of a sentence, which spells units in ASCII: " um" and " degC" with their signs.
[[nodiscard]] std::string in_sentence(std::string_view text);
/// The same of words that are known already, or of their English where they are not.
[[nodiscard]] std::string in_sentence(const std::optional<std::string>& words,
                                      std::string_view english);
/// in_sentence() that begins with an upper-case letter.
[[nodiscard]] std::string opening_sentence(std::string_view text);
/// What stands before the sentence of an error: the title of its code; empty in English.
[[nodiscard]] std::string titled(core::Code code);

/// Text for a terminal: control characters, line breaks and marks that change the direction of
/// writing become "?".
[[nodiscard]] std::string printable(std::string_view text);
/// Columns that UTF-8 text takes in a terminal; East Asian wide characters take two.
[[nodiscard]] std::size_t columns(std::string_view text);
/// The text with spaces behind it, `width` columns at least.
[[nodiscard]] std::string padded(std::string_view text, std::size_t width);

/// What a line may not be broken within: a word, or a wide character with the punctuation that
/// belongs to it.
struct LinePiece {
  std::string text;
  bool after_space = false;  ///< A space, or several, stood before it.
};
/// Text as its pieces: broken at spaces, and before and after wide characters (Chinese has no
/// spaces), but not before closing nor after opening punctuation.
[[nodiscard]] std::vector<LinePiece> line_pieces(std::string_view text);

/// The text cut to at most `limit` columns, with "..." where something was cut.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t limit);

}  // namespace rondure::reports
