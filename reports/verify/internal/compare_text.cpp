#include "reports/verify/internal/compare_text.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/encodings.h"
#include "core/json_text.h"
#include "core/numbers.h"

namespace rondure::reports {
namespace {

using SortedJson = nlohmann::json;

/// A few quoted words around the place where a line begins to differ from another one; control
/// characters as \x1b.
std::string excerpt(std::string_view line, std::string_view other) {
  const auto at = static_cast<std::size_t>(
      std::mismatch(line.begin(), line.end(), other.begin(), other.end()).first - line.begin());
  constexpr std::size_t kBefore = 20;
  constexpr std::size_t kLength = 60;
  const std::size_t from = at > kBefore ? at - kBefore : 0;
  std::string shown = from > 0 ? "\"..." : "\"";
  for (const char c : line.substr(std::min(from, line.size()), kLength)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      shown += fmt::format("\\x{:02x}", byte);
    } else {
      shown += c;
    }
  }
  return shown + (line.size() > from + kLength ? "...\"" : "\"");
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (true) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return lines;
    text.remove_prefix(end + 1);
  }
}

/// The value as JSON, at most 60 bytes of it.
std::string shown(const SortedJson& value) {
  constexpr std::size_t kLongest = 60;
  std::string text = value.dump(-1, ' ', false, SortedJson::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

bool is_close(double a, double b, double tolerance) {
  return a == b || std::abs(a - b) <= tolerance;
}

bool same_value(const SortedJson& a, const SortedJson& b, double tolerance) {
  if (!a.is_number() || !b.is_number()) return a == b;
  return is_close(a.get<double>(), b.get<double>(), tolerance);
}

std::string difference_at(const std::string& pointer, const SortedJson& expected,
                          const SortedJson& found) {
  return fmt::format("{}: the file says {}, the journal gives {}",
                     pointer.empty() ? "the whole file" : pointer, shown(found), shown(expected));
}

/// Fields of a CSV line as written; a quoted field may contain commas.
std::vector<std::string_view> csv_fields(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string_view> fields;
  bool quoted = false;
  std::size_t from = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] != ',' || quoted) continue;
    fields.push_back(line.substr(from, i - from));
    from = i + 1;
  }
  fields.push_back(line.substr(from));
  return fields;
}

using CsvRow = std::vector<std::string_view>;

/// The rows of a table, the header line first, without comments.
std::vector<CsvRow> rows_of(std::string_view text) {
  std::vector<CsvRow> rows;
  for (const std::string_view line : lines_of(text)) {
    if (!line.empty() && line.front() != '#') rows.push_back(csv_fields(line));
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
  return x && y ? is_close(*x, *y, tolerance) : a == b;
}

/// "the file says "7.43", the journal gives "7.42"".
std::string both(std::string_view expected, std::string_view found) {
  return fmt::format("the file says {}, the journal gives {}", excerpt(found, expected),
                     excerpt(expected, found));
}

/// Compares one line of a table; `names` are its columns.
std::optional<std::string> row_difference(std::string_view expected, std::string_view found,
                                          const std::vector<std::string_view>& names,
                                          double tolerance) {
  const auto left = csv_fields(expected);
  const auto right = csv_fields(found);
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    if (left[i] == right[i] || (tolerance > 0.0 && same_field(left[i], right[i], tolerance)))
      continue;
    return fmt::format("column {}: {}",
                       i < names.size() ? std::string(names[i]) : fmt::format("number {}", i + 1),
                       both(left[i], right[i]));
  }
  if (left.size() == right.size()) return std::nullopt;
  return fmt::format("the file has {} fields, the journal gives {}", right.size(), left.size());
}

}  // namespace

std::optional<std::string> first_text_difference(std::string_view expected,
                                                 std::string_view found) {
  const auto left = lines_of(expected);
  const auto right = lines_of(found);
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    if (left[i] != right[i]) return fmt::format("line {}: {}", i + 1, both(left[i], right[i]));
  }
  if (left.size() == right.size()) return std::nullopt;
  return fmt::format("the file has {} lines, the journal gives {}", right.size(), left.size());
}

std::optional<std::string> first_json_difference(std::string_view expected, std::string_view found,
                                                 double tolerance) {
  if (expected == found) return std::nullopt;
  const auto file = core::read_json<SortedJson>(found, "");
  if (!file) return file.error().what;
  const SortedJson left = SortedJson::parse(expected).flatten();
  const SortedJson right = file->flatten();
  for (const auto& [pointer, value] : left.items()) {
    const auto other = right.find(pointer);
    if (other == right.end())
      return fmt::format("{}: missing in the file, the journal gives {}", pointer, shown(value));
    if (!same_value(value, *other, tolerance)) return difference_at(pointer, value, *other);
  }
  for (const auto& [pointer, value] : right.items()) {
    if (left.contains(pointer)) continue;
    return fmt::format("{}: the file says {}, the journal gives nothing there", pointer,
                       shown(value));
  }
  if (tolerance > 0.0) return std::nullopt;
  return "the values are equal, but written differently (spaces, order of keys, a repeated key or "
         "digits): " +
         first_text_difference(expected, found).value_or("");
}

std::optional<std::string> first_csv_difference(std::string_view expected, std::string_view found,
                                                double tolerance) {
  if (expected == found) return std::nullopt;
  const auto left = lines_of(expected);
  const auto right = lines_of(found);
  std::vector<std::string_view> names;  // names of the columns; empty before the header line
  for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
    if (names.empty() && !left[i].starts_with('#')) names = csv_fields(left[i]);
    if (tolerance > 0.0 && left[i].starts_with('#')) continue;  // sentences
    if (auto difference = row_difference(left[i], right[i], names, tolerance)) {
      return fmt::format("line {}, {}", i + 1, *difference);
    }
  }
  if (left.size() != right.size()) {
    return fmt::format("the file has {} lines, the journal gives {}", right.size(), left.size());
  }
  if (tolerance > 0.0) return std::nullopt;
  return "the fields are equal, but the line ends differ: " +
         first_text_difference(expected, found).value_or("");
}

std::optional<std::string> compare_json_values(std::string_view expected, std::string_view found,
                                               double tolerance) {
  const auto file = core::read_json<SortedJson>(found, "");
  if (!file) return file.error().what;
  const SortedJson journal = SortedJson::parse(expected);
  const SortedJson values = file->flatten();
  for (const auto& [pointer, value] : values.items()) {
    const SortedJson::json_pointer place(pointer);
    if (pointer == "/schema_version" || !journal.contains(place)) continue;
    const SortedJson& other = journal.at(place);
    const bool compared = value.is_number() || pointer.ends_with("/verdict");
    if (compared && !same_value(other, value, tolerance))
      return difference_at(pointer, other, value);
  }
  return std::nullopt;
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
