#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.h"

namespace rondure::core {

/// No measured, declared or stored number is greater, in its own unit: 1e9 mm are 1000 km, 1e9 deg
/// near 3 million turns, 1e9 s 30 years. Squares and products of such numbers stay far below the
/// limit of a double, and differences of 1 nm are still resolved.
inline constexpr double kGreatestNumber = 1e9;

/// Whether a number is finite, and no greater in size than kGreatestNumber.
[[nodiscard]] inline bool is_measurable(double value) {
  return value >= -kGreatestNumber && value <= kGreatestNumber;
}

/// The shortest text that reads back to the same double ("0.1", "1e-09"); never a locale's comma.
/// `value` must be finite.
[[nodiscard]] std::string shortest(double value);

/// The shortest decimal text, without an exponent, that reads back to the same double
/// ("0.0000001"). `value` must be finite.
[[nodiscard]] std::string decimal(double value);

/// Numbers in the form of reports and sentences. Independent of the locale: same value, same text.
/// A value that is not finite becomes an en dash; a rounded zero has no sign.
[[nodiscard]] std::string fixed(double value, int decimals);
/// A length in um: three decimals below 1 mm, one above.
[[nodiscard]] std::string um(double length_mm);
/// um() with its sign, including "+".
[[nodiscard]] std::string signed_um(double length_mm);
/// A value without its unit, to `decimals` of a micrometre or microradian: "8.312" in um or urad,
/// "29.998312" in mm.
/// @param length_mm  Of an angle in mrad.
[[nodiscard]] std::string length_in(ValueUnit unit, double length_mm, int decimals);
[[nodiscard]] std::string_view name_of(ValueUnit unit);
/// The same with the micro sign, for a page: "\u00b5m", "mm", "\u00b5rad".
[[nodiscard]] std::string_view sign_of(ValueUnit unit);
/// f of a pose in um: three decimals, two above 100 um.
[[nodiscard]] std::string f_um(double f_mm);
/// A very small length in um, two digits: "1.2e-09".
[[nodiscard]] std::string tiny_um(double length_mm);
/// An angle in degrees.
[[nodiscard]] std::string deg(double angle_rad, int decimals = 4);

/// Reads the whole of `text` as one number that is_measurable(), or nothing. Spaces around it are
/// not accepted.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The multiple of 1 / steps_per_unit nearest to `value` (half to even), as the double nearest to
/// that decimal number: printed with log10(steps_per_unit) decimals and read back it gives the same
/// bits, and a value on the grid is unchanged. So is one that is not finite, or has more than 2^53
/// steps.
/// @param steps_per_unit  A power of ten up to 1e15.
[[nodiscard]] double on_grid(double value, double steps_per_unit);

/// The largest 1, 2 or 5 times a power of ten that is not above `limit`, which must be > 0: the
/// length of a scale bar.
[[nodiscard]] double round_below(double limit);

/// Round values within [low, high], about `wanted` of them (1, 2 or 5 times a power of ten apart),
/// for the ticks of an axis. Only `low` if `high` is not above it.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int wanted);

/// 1, 2, 5, 10, ... within [low, high], both > 0; only powers of ten when there are more than three
/// decades.
[[nodiscard]] std::vector<double> decade_ticks(double low, double high);

/// The angle in degrees, as the number with the fewest digits that is this angle to the last bit:
/// 60 deg of a plan leave as 60, not as 59.99999999999999.
[[nodiscard]] double stated_degrees(double angle_rad);

}  // namespace rondure::core
