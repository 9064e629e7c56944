#include "core/numbers.h"

#include <array>
#include <charconv>
#include <cmath>

namespace rondure::core {

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const char* first = text.data();
  const char* last = first + text.size();
  // from_chars does not accept a plus sign; no second sign may follow it.
  if (last - first > 1 && *first == '+' && first[1] != '-') ++first;
  const auto end = std::from_chars(first, last, value);
  if (end.ec != std::errc() || end.ptr != last || !is_measurable(value)) return std::nullopt;
  return value;
}

double on_grid(double value, double steps_per_unit) {
  constexpr double kExact = 0x1p53;
  const double steps = std::nearbyint(value * steps_per_unit);
  if (!(std::abs(steps) < kExact)) return value;
  return steps / steps_per_unit + 0.0;  // -0.0 becomes 0.0: printed text would lose the sign
}

}  // namespace rondure::core
