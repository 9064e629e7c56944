#include "core/numbers.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/units.h"

namespace rondure::core {

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::string decimal(double value) {
  std::array<char, 1100> digits{};  // the longest double has 1 + 309 or 1 + 1 + 1074 characters
  const auto [end, problem] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  if (problem != std::errc()) return "0";
  const std::string text(digits.data(), end);
  return text == "-0" ? "0" : text;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "\xE2\x80\x93";
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string um(double length_mm) {
  return fixed(length_mm / kMicrometre, std::abs(length_mm) < 1.0 ? 3 : 1);
}

std::string signed_um(double length_mm) {
  std::string text = um(length_mm);
  return text.front() == '-' || !std::isfinite(length_mm) ? text : text.insert(0, 1, '+');
}

std::string length_in(ValueUnit unit, double length_mm, int decimals) {
  constexpr int kMoreOfMillimetre = 3;
  return unit == ValueUnit::kMm ? fixed(length_mm, decimals + kMoreOfMillimetre)
                                : fixed(micrometres(length_mm), decimals);
}

std::string_view name_of(ValueUnit unit) {
  switch (unit) {
    case ValueUnit::kUm:
      return "um";
    case ValueUnit::kMm:
      return "mm";
    case ValueUnit::kUrad:
      return "urad";
  }
  return "";
}

std::string_view sign_of(ValueUnit unit) {
  switch (unit) {
    case ValueUnit::kUm:
      return "\u00b5m";
    case ValueUnit::kMm:
      return "mm";
    case ValueUnit::kUrad:
      return "\u00b5rad";
  }
  return "";
}

std::string f_um(double f_mm) { return fixed(f_mm / kMicrometre, std::abs(f_mm) > 0.1 ? 2 : 3); }

std::string tiny_um(double length_mm) { return fmt::format("{:.2g}", length_mm / kMicrometre); }

std::string deg(double angle_rad, int decimals) { return fixed(angle_rad / kDegree, decimals); }

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
  // -0.0 becomes 0.0, because printed text would lose the sign
  return steps / steps_per_unit + 0.0;
}

double round_below(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= limit) return digit * power;
  }
  return power;
}

std::vector<double> round_ticks(double low, double high, int wanted) {
  if (!(high > low)) return {low};
  const double rough = (high - low) / wanted;
  double step = round_below(rough);
  if ((high - low) / step > 1.6 * wanted) step = round_below(2.6 * step);
  std::vector<double> ticks;
  for (double n = std::ceil(low / step - 1e-9); n * step <= high + 1e-9 * step; n += 1.0) {
    ticks.push_back(n * step);
  }
  return ticks;
}

std::vector<double> decade_ticks(double low, double high) {
  const bool powers_only = std::log10(high / low) > 3.0;
  std::vector<double> ticks;
  for (double power = std::pow(10.0, std::floor(std::log10(low))); power <= high; power *= 10.0) {
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * power;
      if (value >= low && value <= high && (digit == 1.0 || !powers_only)) ticks.push_back(value);
    }
  }
  return ticks;
}

double stated_degrees(double angle_rad) {
  const double deg = angle_rad / kDegree;
  for (int digits = 1; std::isfinite(deg) && digits <= std::numeric_limits<double>::max_digits10;
       ++digits) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), deg,
                                   std::chars_format::general, digits);
    double stated = 0.0;
    std::from_chars(text.data(), end.ptr, stated);
    if (stated * kDegree == angle_rad) return stated;
  }
  return deg;
}

}  // namespace rondure::core
