#include "record/points/internal/row_names.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>

#include "record/points/internal/head.h"
#include "record/points/internal/units.h"

namespace rondure::record {
namespace {

/// Begins of words for a feature that is touched as a whole.
constexpr auto kShapes = std::to_array<std::string_view>(
    {"cyl", "zyl", "cilin", "cone", "kegel", "sphe", "kugel", "圆柱", "円筒"});
constexpr std::string_view kDigits = "0123456789";

/// The length of "CYL1" or "Zylinder12" at the begin of a text in lower case; 0 without one.
std::size_t feature_at(std::string_view text) {
  const auto begins = [&](std::string_view shape) { return text.starts_with(shape); };
  if (std::ranges::none_of(kShapes, begins)) return 0;
  const std::size_t number = text.find_first_of("0123456789._:/-# ");
  if (number == std::string_view::npos || kDigits.find(text[number]) == std::string_view::npos) {
    return 0;
  }
  return std::min(text.find_first_not_of(kDigits, number), text.size());
}

}  // namespace

bool names_features(const ColumnText& column) {
  std::set<std::string_view> names(column.begin(), column.end());
  names.erase("");
  return 2 * names.size() <= column.size();
}

bool counts_rows(const ColumnText& column) {
  std::size_t numbers = 0;
  std::size_t rises = 0;
  std::size_t before = 0;
  for (const std::string_view field : column) {
    const auto number = count_of(field);
    if (!number) continue;
    rises += numbers > 0 && *number > before ? 1 : 0;
    before = *number;
    ++numbers;
  }
  return numbers >= 3 && 3 * numbers >= 2 * column.size() && 4 * rises >= 3 * (numbers - 1);
}

std::string_view feature_of_point(std::string_view name) {
  const std::size_t size = feature_at(lower_case(name));
  const bool point = size > 0 && size + 1 < name.size() &&
                     std::string_view("._:/- ").find(name[size]) != std::string_view::npos;
  return name.substr(0, point ? size : 0);
}

std::string feature_of_heading(std::string_view line) {
  const NameWords words = words_in(line);
  if (words.empty()) return {};
  for (const std::string& text : {words[0], words.size() > 1 ? words[0] + words[1] : words[0]}) {
    if (feature_at(text) == text.size()) return text;
  }
  return {};
}

}  // namespace rondure::record
