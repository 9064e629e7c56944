#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "core/result.h"

// Private to the room: functions shared by the CSV readers. Plain CSV: a header line that names the
// columns, one row per line, fields separated by commas, decimal points, no quotes.

namespace rondure::record {

/// Most rows of a table.
inline constexpr std::size_t kMostRows = 20'000'000;
[[nodiscard]] core::Error too_many_rows();

/// Takes the first line off a text and returns it without its LF or CRLF.
[[nodiscard]] std::string_view take_line(std::string_view& text);

[[nodiscard]] core::Error syntax_error(std::string what);

/// Whether a line is blank or a comment.
[[nodiscard]] bool holds_no_row(std::string_view line);

/// The fields of a line without blanks around them.
[[nodiscard]] std::vector<std::string_view> split_fields(std::string_view line);

/// At most 40 characters of a file's text, in quotes, with the bytes escaped that
/// show nothing: blanks but the common one, marks, controls.
[[nodiscard]] std::string quoted_text(std::string_view text);

/// The error for a line in a format that spreadsheets or editors write, or nothing.
[[nodiscard]] std::optional<core::Error> foreign_format(std::string_view line);

/// The error in a field that must be a number core::is_measurable(), or nothing.
[[nodiscard]] std::optional<core::Error> explain_field(std::string_view field,
                                                       std::string_view column,
                                                       std::string_view unit);

/// The unit at the end of a column's name ("um" in "H1_um"), or "".
[[nodiscard]] std::string_view unit_of_column(std::string_view name);

/// The error for a field of the header that names none of the columns: kWrongUnit when one of them
/// has the same name with another unit, kSyntax otherwise.
/// @param list  The columns in the wording of messages.
/// @param rule  End of the sentence about a wrong unit.
[[nodiscard]] core::Error unknown_column(std::string_view field,
                                         std::span<const std::string_view> columns,
                                         std::string_view list, std::string_view rule = "");

[[nodiscard]] bool is_utf16(std::string_view text);
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

/// Reads a whole table. The first line with content is the header, each later one a row.
///
/// @param name     The file's name for `where` ("name:line").
/// @param header   Takes the header line; returns core::Result<void>.
/// @param row      Takes a row and its line number; returns core::Result<void>.
/// @param no_rows  Takes whether the table has a header; returns the sentence for a table without
///                 rows.
/// @return  The error of `header` or `row` with its place, kSyntax for UTF-16 and for more than
///          kMostRows rows, kNoPoints.
template <class Header, class Row, class NoRows>
core::Result<void> read_table(std::string_view text, std::string_view name, const Header& header,
                              const Row& row, const NoRows& no_rows) {
  std::string_view rest = without_byte_order_mark(text);
  std::size_t number = 0;  // line number, from 1
  const auto here = [&] { return fmt::format("{}:{}", name, std::max<std::size_t>(number, 1)); };
  if (is_utf16(text)) {
    return core::fail(core::Code::kSyntax, "the file is saved as UTF-16; save it as UTF-8", here());
  }
  bool in_rows = false;
  std::size_t rows = 0;
  while (!rest.empty()) {
    ++number;
    if (rows == kMostRows) return core::fail(too_many_rows().at(here()));
    const std::string_view line = take_line(rest);
    if (holds_no_row(line)) continue;
    const core::Result<void> read = in_rows ? row(line, number) : header(line);
    if (!read) return core::fail(read.error().at(here()));
    rows += in_rows ? 1 : 0;
    in_rows = true;
  }
  if (rows > 0) return {};
  return core::fail(core::Code::kNoPoints, no_rows(in_rows), here());
}

}  // namespace rondure::record
