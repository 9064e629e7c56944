#include "reports/verify/internal/compare_values.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/numbers.h"
#include "reports/verify/internal/compare_text.h"

namespace rondure::reports {
namespace {

using SortedJson = nlohmann::json;

constexpr const char* kSchemaVersion = "/schema_version";

bool close(double a, double b, double tolerance) { return a == b || std::abs(a - b) <= tolerance; }

/// Walks two documents side by side until the first difference.
class JsonWalk {
 public:
  explicit JsonWalk(double tolerance) : tolerance_(tolerance) {}

  void walk(const SortedJson& expected, const SortedJson& found, const std::string& pointer) {
    if (out_.difference || pointer == kSchemaVersion) return;
    if (found.is_number()) {
      compare(expected, found, pointer);
    } else if (expected.is_object() && found.is_object()) {
      for (const auto& [key, value] : found.items()) {
        const auto other = expected.find(key);
        if (other != expected.end()) walk(*other, value, pointer + "/" + key);
      }
    } else if (expected.is_array() && found.is_array()) {
      for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
        walk(expected[i], found[i], fmt::format("{}/{}", pointer, i));
      }
    } else if (pointer.ends_with("/verdict") && expected != found) {
      tell(expected, found, pointer);
    }
  }
  [[nodiscard]] const ValueComparison& result() const { return out_; }

 private:
  void compare(const SortedJson& expected, const SortedJson& found, const std::string& pointer) {
    ++out_.numbers;
    if (expected.is_number() && close(expected.get<double>(), found.get<double>(), tolerance_)) {
      return;
    }
    tell(expected, found, pointer);
  }
  void tell(const SortedJson& expected, const SortedJson& found, const std::string& pointer) {
    constexpr auto kReplace = SortedJson::error_handler_t::replace;
    out_.difference = fmt::format("{}: the file says {}, the journal gives {}", pointer,
                                  found.dump(-1, ' ', false, kReplace).substr(0, 60),
                                  expected.dump(-1, ' ', false, kReplace).substr(0, 60));
  }

  double tolerance_;
  ValueComparison out_;
};

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

/// Places of the columns that two header lines have in common.
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

/// Whether two fields say the same, and whether they are numbers.
std::pair<bool, bool> same_field(std::string_view a, std::string_view b, double tolerance) {
  const auto x = core::parse_number(a);
  const auto y = core::parse_number(b);
  if (!x || !y) return {a == b, false};
  return {close(*x, *y, tolerance), true};
}

}  // namespace

ValueComparison compare_json_values(std::string_view expected, std::string_view found,
                                    double tolerance) {
  const SortedJson left = SortedJson::parse(expected, nullptr, false);
  const SortedJson right = SortedJson::parse(found, nullptr, false);
  if (right.is_discarded()) return {"it is no JSON any more", 0};
  JsonWalk walk(tolerance);
  walk.walk(left, right, "");
  return walk.result();
}

ValueComparison compare_csv_values(std::string_view expected, std::string_view found,
                                   double tolerance) {
  const auto left = rows_of(expected);
  const auto right = rows_of(found);
  if (left.size() != right.size()) {
    return {fmt::format("the file has {} rows, the journal gives {}", right.size(), left.size()),
            0};
  }
  ValueComparison out;
  if (right.empty()) return out;
  const auto columns = common_columns(left.front(), right.front());
  if (columns.empty()) return {"it has no column that this version writes", 0};
  for (std::size_t row = 1; row < right.size(); ++row) {
    for (const auto& [l, r] : columns) {
      const std::string_view a = l < left[row].size() ? left[row][l] : std::string_view();
      const std::string_view b = r < right[row].size() ? right[row][r] : std::string_view();
      const auto [same, number] = same_field(a, b, tolerance);
      out.numbers += number ? 1 : 0;
      if (same) continue;
      out.difference = fmt::format("row {}, column {}: the file says {}, the journal gives {}", row,
                                   right.front()[r], b.substr(0, 60), a.substr(0, 60));
      return out;
    }
  }
  return out;
}

}  // namespace rondure::reports
