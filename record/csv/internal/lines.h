#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

// Private to the room: what every CSV reader here does alike. Plain CSV: a header line naming the
// columns, a row a line, fields between commas, decimals with a point, no quotes.

namespace rondure::record {

/// Hands out lines without their LF or CRLF and counts them from 1.
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::optional<std::string_view> next();

  /// What is still to be read, from the start of a line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// Passes over the next line, which takes so many bytes with its end.
  void pass(std::size_t bytes) {
    rest_.remove_prefix(bytes);
    ++number_;
  }

  [[nodiscard]] std::size_t number() const { return number_; }
  [[nodiscard]] std::size_t bytes_left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

[[nodiscard]] core::Error syntax_error(std::string what);

/// Blank lines and comments hold no row.
[[nodiscard]] bool holds_nothing(std::string_view line);

/// The fields of a line without blanks around them.
[[nodiscard]] std::vector<std::string_view> split_fields(std::string_view line);

/// At most 40 characters of a file's text, in quotes, with bytes that do not print spelled out.
[[nodiscard]] std::string quoted_text(std::string_view text);

/// What spreadsheets and editors do to a table, or nothing.
[[nodiscard]] std::optional<core::Error> foreign_format(std::string_view line);

/// What is wrong with one field that has to be a number core::is_measurable(), or nothing.
[[nodiscard]] std::optional<core::Error> explain_field(std::string_view field,
                                                       std::string_view column,
                                                       std::string_view unit);

[[nodiscard]] bool is_utf16(std::string_view text);
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

}  // namespace rondure::record
