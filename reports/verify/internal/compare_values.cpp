#include "reports/verify/internal/compare_values.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "core/numbers.h"
#include "core/utf8.h"
#include "reports/verify/internal/compare_text.h"

namespace rondure::reports {
namespace {

using SortedJson = nlohmann::json;

constexpr const char* kSchemaVersion = "/schema_version";

bool close(double a, double b, double tolerance) { return a == b || std::abs(a - b) <= tolerance; }

std::string saying(const SortedJson& expected, const SortedJson& found,
                   const std::string& pointer) {
  constexpr auto kReplace = SortedJson::error_handler_t::replace;
  return fmt::format("{}: the file says {}, the journal gives {}", pointer,
                     found.dump(-1, ' ', false, kReplace).substr(0, 60),
                     expected.dump(-1, ' ', false, kReplace).substr(0, 60));
}

/// Compares two documents in parallel up to the first difference.
std::optional<std::string> walk(const SortedJson& expected, const SortedJson& found,
                                const std::string& pointer, double tolerance) {
  if (pointer == kSchemaVersion) return std::nullopt;
  std::optional<std::string> difference;
  if (found.is_number()) {
    if (!expected.is_number() || !close(expected.get<double>(), found.get<double>(), tolerance)) {
      difference = saying(expected, found, pointer);
    }
  } else if (expected.is_object() && found.is_object()) {
    for (auto item = found.begin(); item != found.end() && !difference; ++item) {
      const auto other = expected.find(item.key());
      if (other == expected.end()) continue;
      difference = walk(*other, *item, pointer + "/" + item.key(), tolerance);
    }
  } else if (expected.is_array() && found.is_array()) {
    for (std::size_t i = 0; i < std::min(expected.size(), found.size()) && !difference; ++i) {
      difference = walk(expected[i], found[i], fmt::format("{}/{}", pointer, i), tolerance);
    }
  } else if (pointer.ends_with("/verdict") && expected != found) {
    difference = saying(expected, found, pointer);
  }
  return difference;
}

using CsvRow = std::vector<std::string_view>;

/// The rows of a table, the header line first, without comments.
std::vector<CsvRow> rows_of(std::string_view text) {
  std::vector<CsvRow> rows;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (!line.empty() && line.front() != '#') rows.push_back(csv_fields(line));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return rows;
}

/// Indices of the columns that two header lines have in common.
std::vector<std::pair<std::size_t, std::size_t>> common_columns(const CsvRow& expected,
                                                                const CsvRow& found) {
  std::vector<std::pair<std::size_t, std::size_t>> common;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto other = std::find(expected.begin(), expected.end(), found[i]);
    if (other != expected.end()) {
      common.emplace_back(static_cast<std::size_t>(other - expected.begin()), i);
    }
  }
  return common;
}

/// Whether two fields are equal: as numbers, or as text.
bool same_field(std::string_view a, std::string_view b, double tolerance) {
  const auto x = core::parse_number(a);
  const auto y = core::parse_number(b);
  return x && y ? close(*x, *y, tolerance) : a == b;
}

}  // namespace

std::optional<std::string> compare_json_values(std::string_view expected, std::string_view found,
                                               double tolerance) {
  const auto right = core::read_json<SortedJson>(found, "");
  if (!right) return right.error().what;
  return walk(SortedJson::parse(expected, nullptr, false), *right, "", tolerance);
}

std::optional<std::string> compare_csv_values(std::string_view expected, std::string_view found,
                                              double tolerance) {
  const auto left = rows_of(expected);
  const auto right = rows_of(found);
  if (left.size() != right.size())
    return fmt::format("the file has {} rows, the journal gives {}", right.size(), left.size());
  if (right.empty()) return std::nullopt;
  const auto columns = common_columns(left.front(), right.front());
  if (columns.empty()) return "it has no column that this version writes";
  for (std::size_t row = 1; row < right.size(); ++row) {
    for (const auto& [l, r] : columns) {
      const std::string_view a = l < left[row].size() ? left[row][l] : std::string_view();
      const std::string_view b = r < right[row].size() ? right[row][r] : std::string_view();
      if (same_field(a, b, tolerance)) continue;
      return fmt::format("row {}, column {}: the file says {}, the journal gives {}", row,
                         right.front()[r], core::printable(b.substr(0, 60)),
                         core::printable(a.substr(0, 60)));
    }
  }
  return std::nullopt;
}

}  // namespace rondure::reports
