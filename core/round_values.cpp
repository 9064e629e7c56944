#include "core/round_values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/units.h"

namespace rondure::core {

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
