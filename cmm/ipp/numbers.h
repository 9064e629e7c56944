#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::cmm::ipp {

[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// How long the numbers are that are sent.
enum class NumberForm {
  kSixteenDigits,      ///< As the protocol allows.
  kSixteenCharacters,  ///< With sign, point and exponent, for those who refuse longer ones.
};

/// The number as we send it: the shortest text that reads back to the same double, at most 16
/// digits, which the protocol allows ("-0.25", "300", "1e-10"). A double that needs 17 is rounded;
/// positions on the grid of 1e-10 mm and directions on that of 1e-15 never do (grid.h). With
/// kSixteenCharacters longer texts are rounded, directions to some 1e-13.
/// `value` must be finite.
[[nodiscard]] std::string wire_number(double value, NumberForm form = NumberForm::kSixteenDigits);

/// Reads a number of the grammar: an optional sign, digits with at most one point and at least one
/// digit, an exponent of one to three digits. Nothing for anything else and for a number that no
/// double holds.
/// @param max_digits  Of the mantissa; 16 by the protocol, more where we are liberal.
[[nodiscard]] std::optional<double> read_number(std::string_view text, int max_digits = 16);

}  // namespace rondure::cmm::ipp
