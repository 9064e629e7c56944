#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::core {

/// Upper limit of every number that is measured, declared or stored, in its own unit: 1e9 mm are
/// 1000 km, 1e9 deg are nearly 3 million turns, 1e9 s are 30 years. Squares and products of such
/// numbers stay far from the range limit of a double, and differences of 1 nm remain resolvable.
inline constexpr double kGreatestNumber = 1e9;

/// Whether a value is finite and its absolute value is at most kGreatestNumber.
[[nodiscard]] inline bool is_measurable(double value) {
  return value >= -kGreatestNumber && value <= kGreatestNumber;
}

/// Returns the shortest text that reads back to the same double ("0.1", "1e-09"), with a decimal
/// point in every locale.
/// @pre `value` is finite.
[[nodiscard]] std::string shortest(double value);

/// Reads the whole of `text` as one number, without surrounding spaces.
/// @return The number, or nothing if `text` is not a number or the number fails is_measurable().
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// Rounds `value` to the nearest multiple of 1 / steps_per_unit (half to even) and returns the
/// double nearest to that decimal number. Printed with log10(steps_per_unit) decimals and read
/// back, it gives the same bits. A value on the grid is returned unchanged, and so is a value that
/// is not finite or has more than 2^53 steps.
/// @param steps_per_unit  A power of ten up to 1e15.
[[nodiscard]] double on_grid(double value, double steps_per_unit);

}  // namespace rondure::core
