#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::core {

/// The shortest text that reads back to the same double ("0.1", "1e-09"); never a locale's comma.
/// `value` must be finite.
[[nodiscard]] std::string shortest(double value);

/// Reads the whole of `text` as one finite number, or nothing. Spaces around it are not accepted.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The multiple of 1 / steps_per_unit next to `value` (half to even), as the double next to that
/// decimal number: printed with log10(steps_per_unit) decimals and read back it gives the same
/// bits, and a value on the grid stays as it is. What is not finite, or has more than 2^53 steps,
/// too.
/// @param steps_per_unit  A power of ten up to 1e15.
[[nodiscard]] double on_grid(double value, double steps_per_unit);

}  // namespace rondure::core
