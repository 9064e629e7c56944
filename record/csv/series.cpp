#include "record/csv/series.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/numbers.h"
#include "record/csv/internal/lines.h"

namespace rondure::record {
namespace {

using core::Code;

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

/// A table's columns, as the file orders them.
struct Layout {
  std::vector<std::string_view> fields;  ///< Fields of the header.
  std::vector<std::size_t> wanted;       ///< For each column of the result, its index in `wanted`.
  /// For each field its index in the result, or nothing for a skipped one.
  std::vector<std::optional<std::size_t>> places;
};

/// @param list  The columns in the wording of messages.
core::Result<Layout> read_layout(std::string_view line, std::span<const WantedColumn> wanted,
                                 std::string_view list, std::span<const ColumnName> names) {
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
  std::vector<std::string_view> known;
  for (const WantedColumn& column : wanted) known.push_back(column.name);
  for (std::size_t i = 0; i < out.fields.size(); ++i) {
    if (out.places[i] || !names.empty()) continue;
    return core::fail(unknown_column(out.fields[i], known, list));
  }
  for (std::size_t w = 0; w < wanted.size(); ++w) {
    if (!wanted[w].required || std::count(out.wanted.begin(), out.wanted.end(), w) > 0) continue;
    return core::fail(syntax_error(fmt::format("column {} is missing in {}; the columns are {}",
                                               quoted_text(name_in_file(wanted[w], names)),
                                               quoted_text(line), list)));
  }
  return out;
}

/// Adds a row to the values of a series.
/// @param stated_degC  Of a series whose last column is the temperature that the file states once.
core::Result<void> read_row(std::string_view line, const Layout& layout,
                            std::span<const WantedColumn> wanted,
                            const std::optional<double>& stated_degC, Series& series) {
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
    const auto words = wanted[layout.wanted[*layout.places[i]]].words;
    if (!words.empty()) {
      const auto at = std::find(words.begin(), words.end(), fields[i]);
      if (at == words.end()) {
        return core::fail(
            syntax_error(fmt::format("{} is {}; {} is expected", column.name,
                                     quoted_text(fields[i]), fmt::join(words, ", "))));
      }
      series.values[start + *layout.places[i]] = static_cast<double>(at - words.begin());
      continue;
    }
    const auto value = core::parse_number(fields[i]);
    if (!value) {
      const auto error = explain_field(fields[i], column.name, column.unit);
      return core::fail(error.value_or(syntax_error(
          fmt::format("{} is {}; a number is expected", column.name, quoted_text(fields[i])))));
    }
    series.values[start + *layout.places[i]] = *value;
  }
  if (series.columns.size() > layout.wanted.size()) series.values.back() = *stated_degC;
  return {};
}

core::Result<void> check_names(std::span<const WantedColumn> wanted, std::string_view list,
                               std::span<const ColumnName> names) {
  for (const ColumnName& name : names) {
    const bool known = std::any_of(wanted.begin(), wanted.end(),
                                   [&](const auto& column) { return column.name == name.wanted; });
    if (!known) {
      return core::fail_with(Code::kBadOption, "{} is no column of this data; the columns are {}",
                             quoted_text(name.wanted), list);
    }
    const std::string_view unit = unit_of_column(name.in_file);
    const std::string_view read = unit_of_column(name.wanted);
    if (name.converted || unit.empty() || read.empty() || unit == read) continue;
    return core::fail_with(Code::kWrongUnit,
                           "column {} is read as {}, in {}: convert its numbers, and name the "
                           "column after their unit",
                           quoted_text(name.in_file), name.wanted, read);
  }
  return {};
}

/// The temperature that a comment above the header states for all rows; none where none does.
core::Result<std::optional<double>> stated_temperature(std::string_view text,
                                                       std::string_view name) {
  std::string_view rest = without_byte_order_mark(text);
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::string_view line = take_line(rest);
    if (!holds_no_row(line)) break;
    const std::size_t at = line.find(kTemperatureColumn);
    if (at == std::string_view::npos ||
        line.substr(0, at).find_first_not_of("# \t") != std::string_view::npos) {
      continue;  // some other comment
    }
    std::string_view said = line.substr(at + kTemperatureColumn.size());
    const std::size_t first = said.find_first_not_of(" \t:=");
    said = first == std::string_view::npos ? std::string_view() : said.substr(first);
    said = said.substr(0, said.find_last_not_of(" \t") + 1);
    const auto value = core::parse_number(said);
    if (value) return std::optional<double>(*value);
    return core::fail(syntax_error(fmt::format("{} is {}; a number is expected", kTemperatureColumn,
                                               quoted_text(said)))
                          .at(fmt::format("{}:{}", name, number)));
  }
  return std::optional<double>();
}

/// The wanted columns and the one that every table may have.
std::vector<WantedColumn> with_temperature(std::span<const WantedColumn> wanted) {
  std::vector<WantedColumn> out(wanted.begin(), wanted.end());
  out.push_back({kTemperatureColumn, false});
  return out;
}

}  // namespace

core::Result<Series> parse_series_csv(std::string_view text, std::string_view name,
                                      std::span<const WantedColumn> wanted,
                                      std::span<const ColumnName> names) {
  const std::vector<WantedColumn> all = with_temperature(wanted);
  const std::string list = list_of(wanted);
  TRY_DO(check_names(all, list, names));
  TRY(const auto stated_degC, stated_temperature(text, name));
  Series out;
  Layout layout;
  const auto header = [&](std::string_view line) -> core::Result<void> {
    TRY(layout, read_layout(line, all, list, names));
    if (layout.wanted.empty() || layout.wanted.front() >= wanted.size()) {
      return core::fail(syntax_error(fmt::format(
          "none of the columns {} stands in the first line, {}", list, quoted_text(line))));
    }
    for (const std::size_t w : layout.wanted) {
      out.columns.push_back({std::string(all[w].name), std::string(unit_of_column(all[w].name))});
    }
    if (stated_degC && !out.column(kTemperatureColumn)) {
      out.columns.push_back(
          {std::string(kTemperatureColumn), std::string(unit_of_column(kTemperatureColumn))});
    }
    return {};
  };
  TRY_DO(read_table(
      text, name, header,
      [&](std::string_view line, std::size_t) {
        return read_row(line, layout, all, stated_degC, out);
      },
      [&](bool) {
        return fmt::format(
            "the file holds no rows; a header line {} and a row a sample are expected", list);
      }));
  return out;
}

}  // namespace rondure::record
