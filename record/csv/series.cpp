#include "record/csv/series.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

using core::Code;

constexpr std::array<std::string_view, 14> kUnits = {
    "um", "mm", "m", "nm", "inch", "deg", "rad", "s", "ms", "rpm", "degC", "V", "mV", "N"};

std::string list_of(std::span<const WantedColumn> wanted) {
  std::string out;
  for (const WantedColumn& column : wanted) {
    out += fmt::format("{}{}{}{}", out.empty() ? "" : ",", column.required ? "" : "[", column.name,
                       column.required ? "" : "]");
  }
  return out;
}

/// The name under which the file holds a wanted column.
std::string_view name_in_file(const WantedColumn& column, std::span<const ColumnName> names) {
  for (const ColumnName& name : names) {
    if (name.wanted == column.name) return name.in_file;
  }
  return column.name;
}

/// The error for a header field that is not wanted.
core::Error unknown_column(std::string_view field, std::span<const WantedColumn> wanted) {
  for (const WantedColumn& column : wanted) {
    const std::string_view unit = unit_of_column(column.name);
    if (unit.empty() || field == column.name || stem_of(field) != stem_of(column.name)) continue;
    return {Code::kWrongUnit,
            fmt::format("column {} is not in {}; give {}", quoted_text(field), unit, column.name),
            {}};
  }
  return syntax_error(fmt::format("column {} is unknown; the first line must name the columns {}",
                                  quoted_text(field), list_of(wanted)));
}

/// The columns of a table, in the order of the file.
struct Layout {
  std::vector<std::string_view> fields;  ///< Fields of the header.
  std::vector<std::size_t> wanted;       ///< For each column of the result, its index in `wanted`.
  /// For each field its index in the result, or nothing for a skipped one.
  std::vector<std::optional<std::size_t>> places;
};

core::Result<Layout> read_layout(std::string_view line, std::span<const WantedColumn> wanted,
                                 std::span<const ColumnName> names) {
  if (auto foreign = foreign_format(line)) return core::fail(*std::move(foreign));
  Layout out;
  out.fields = split_fields(line);
  out.places.resize(out.fields.size());
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    const std::string_view called = name_in_file(wanted[w], names);
    const auto found = std::find(out.fields.begin(), out.fields.end(), called);
    if (found == out.fields.end()) continue;
    if (std::find(found + 1, out.fields.end(), called) != out.fields.end()) {
      return core::fail(syntax_error(fmt::format("column {} stands twice", quoted_text(called))));
    }
    out.places[static_cast<std::size_t>(found - out.fields.begin())] = out.wanted.size();
    out.wanted.push_back(w);
  }
  for (std::size_t i = 0; i < out.fields.size(); ++i) {
    if (!out.places[i] && names.empty()) return core::fail(unknown_column(out.fields[i], wanted));
  }
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    if (!wanted[w].required || std::count(out.wanted.begin(), out.wanted.end(), w) > 0) continue;
    return core::fail(syntax_error(fmt::format("column {} is missing in {}; the columns are {}",
                                               quoted_text(name_in_file(wanted[w], names)),
                                               quoted_text(line), list_of(wanted))));
  }
  return out;
}

/// Adds a row to the values of a series.
core::Result<void> read_row(std::string_view line, const Layout& layout, Series& series) {
  const auto fields = split_fields(line);
  if (fields.size() != layout.fields.size()) {
    if (auto foreign = foreign_format(line)) return core::fail(*std::move(foreign));
    return core::fail(syntax_error(fmt::format("{} field{} in {}, {} expected", fields.size(),
                                               fields.size() == 1 ? "" : "s", quoted_text(line),
                                               layout.fields.size())));
  }
  const std::size_t start = series.values.size();
  series.values.resize(start + series.columns.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (!layout.places[i]) continue;
    const SeriesColumn& column = series.columns[*layout.places[i]];
    const auto value = core::parse_number(fields[i]);
    if (!value) {
      const auto error = explain_field(fields[i], column.name, column.unit);
      return core::fail(error.value_or(syntax_error(
          fmt::format("{} is {}; a number is expected", column.name, quoted_text(fields[i])))));
    }
    series.values[start + *layout.places[i]] = *value;
  }
  return {};
}

core::Result<void> check_names(std::span<const WantedColumn> wanted,
                               std::span<const ColumnName> names) {
  for (const ColumnName& name : names) {
    const bool known = std::any_of(wanted.begin(), wanted.end(),
                                   [&](const auto& column) { return column.name == name.wanted; });
    if (known) continue;
    return core::fail(Code::kBadOption,
                      fmt::format("{} is no column of this data; the columns are {}",
                                  quoted_text(name.wanted), list_of(wanted)));
  }
  return {};
}

}  // namespace

std::string_view unit_of_column(std::string_view name) {
  const std::size_t cut = name.rfind('_');
  if (cut == std::string_view::npos || cut == 0) return {};
  const std::string_view unit = name.substr(cut + 1);
  return std::find(kUnits.begin(), kUnits.end(), unit) == kUnits.end() ? std::string_view() : unit;
}

std::string_view stem_of(std::string_view name) {
  const std::string_view unit = unit_of_column(name);
  return unit.empty() ? name : name.substr(0, name.size() - unit.size() - 1);
}

core::Result<Series> parse_series_csv(std::string_view text, std::string_view name,
                                      std::span<const WantedColumn> wanted,
                                      std::span<const ColumnName> names) {
  if (auto known = check_names(wanted, names); !known) return core::fail(known.error());
  CsvLines lines(without_byte_order_mark(text));
  const auto here = [&] {
    return fmt::format("{}:{}", name, std::max<std::size_t>(lines.number(), 1));
  };
  if (is_utf16(text)) {
    return core::fail(Code::kSyntax, "the file is saved as UTF-16; save it as UTF-8", here());
  }
  Series out;
  std::optional<Layout> layout;
  while (const auto line = lines.next()) {
    if (holds_nothing(*line)) continue;
    if (!layout) {
      auto found = read_layout(*line, wanted, names);
      if (!found) return core::fail(found.error().at(here()));
      layout = *std::move(found);
      if (layout->wanted.empty()) {
        return core::fail(
            syntax_error(fmt::format("none of the columns {} stands in the first line, {}",
                                     list_of(wanted), quoted_text(*line)))
                .at(here()));
      }
      for (const std::size_t w : layout->wanted) {
        out.columns.push_back(
            {std::string(wanted[w].name), std::string(unit_of_column(wanted[w].name))});
      }
    } else if (auto row = read_row(*line, *layout, out); !row) {
      return core::fail(row.error().at(here()));
    }
  }
  if (!layout || out.values.empty()) {
    return core::fail(Code::kNoPoints,
                      fmt::format("the file holds no rows; a header line {} and a row a sample are "
                                  "expected",
                                  list_of(wanted)),
                      here());
  }
  return out;
}

}  // namespace rondure::record
