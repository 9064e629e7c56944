#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::cmm::ipp {

[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Length of the numbers that are sent.
enum class NumberForm {
  kSixteenDigits,  ///< At most 16 digits, as the protocol allows.
  /// Including sign, point and exponent, for servers that refuse longer numbers.
  kSixteenCharacters,
  kFiveDecimals,  ///< "-0.25000", as some servers write every number.
};

/// Writes a number for the wire: the shortest text that reads back to the same double, at most 16
/// digits as the protocol allows ("-0.25", "300", "1e-10"). A double that needs 17 digits is
/// rounded; positions on the grid of 1e-10 mm and directions on that of 1e-15 never need it
/// (grid.h). With kSixteenCharacters longer texts are rounded, directions to about 1e-13.
/// @pre `value` is finite.
[[nodiscard]] std::string wire_number(double value, NumberForm form = NumberForm::kSixteenDigits);

/// Reads a number of the grammar: an optional sign, digits with at most one point and at least one
/// digit, an exponent of one to three digits. Nothing for any other text and for a number outside
/// the range of double.
/// @param max_digits  Limit for the mantissa; 16 by the protocol, more for liberal parsing.
[[nodiscard]] std::optional<double> read_number(std::string_view text, int max_digits = 16);

}  // namespace rondure::cmm::ipp
