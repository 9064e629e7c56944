#include "app/text/length_word.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/numbers.h"

namespace rondure::app {
namespace {

/// Without blanks at either end.
std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

core::Result<double> length_from(std::string_view word) {
  const auto refuse = [&](const char* why) {
    return core::fail(
        core::Code::kBadOption,
        fmt::format("\"{}\" {}; write a length as 1um, 0.001mm or 1000nm", word, why));
  };
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits = {
      {{"um", 1e-3}, {"mm", 1.0}, {"nm", 1e-6}}};
  const std::string_view text = trimmed(word);
  if (core::parse_number(text)) return refuse("has no unit");
  for (const auto& [unit, unit_mm] : kUnits) {
    if (!text.ends_with(unit)) continue;
    const auto number = core::parse_number(trimmed(text.substr(0, text.size() - unit.size())));
    if (!number) return refuse("is no number with a unit");
    const double length_mm = *number * unit_mm;
    if (!(length_mm > 0.0) || !std::isfinite(length_mm)) return refuse("is not above 0");
    return length_mm;
  }
  return refuse("is no length in um, mm or nm");
}

}  // namespace rondure::app
