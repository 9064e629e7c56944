#pragma once

#include <string>
#include <string_view>

namespace rondure::reports {

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

/// "1 touch", "3 touches": the number and the word in its number.
[[nodiscard]] std::string count(std::size_t number, std::string_view one, std::string_view many);

/// The text with the first letter in upper case (ASCII).
[[nodiscard]] std::string capitalised(std::string_view text);

/// The text as well-formed UTF-8 without NUL; what is neither becomes U+FFFD.
[[nodiscard]] std::string well_formed(std::string_view text);

/// Text that any file format can hold: well-formed UTF-8 without control characters (line feed and
/// tab stay) and without the codes that XML 1.0 refuses; what is none of these becomes U+FFFD.
[[nodiscard]] std::string clean(std::string_view text);

/// The shortest decimal text, without an exponent, that reads back to the same double
/// ("0.0000001"). `value` must be finite.
[[nodiscard]] std::string decimal(double value);

/// Text that stays text in HTML, in elements and in quoted attributes: & < > " ' become entities,
/// control characters the replacement character.
[[nodiscard]] std::string escaped(std::string_view text);
/// Escaped and isolated (<bdi>), so that a right-to-left name does not reorder its neighbours.
[[nodiscard]] std::string isolated(std::string_view text);

/// A sentence of the program, which spells units in ASCII, as a page shows it: " um" and " degC"
/// with their signs, escaped and isolated.
[[nodiscard]] std::string in_sentence(std::string_view text);

/// Text for a terminal: control characters, line breaks and marks that change the direction of
/// writing become "?".
[[nodiscard]] std::string printable(std::string_view text);
/// Columns that UTF-8 text takes in a terminal; East Asian wide characters take two.
[[nodiscard]] std::size_t columns(std::string_view text);
/// The text cut to at most `limit` columns, with "..." where something was cut.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t limit);

}  // namespace rondure::reports
