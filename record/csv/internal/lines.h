#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

// Private to the room: functions shared by the CSV readers. Plain CSV: a header line that names the
// columns, one row per line, fields separated by commas, decimal points, no quotes.

namespace rondure::record {

/// Returns lines without their LF or CRLF and counts them from 1.
class CsvLines {
 public:
  explicit CsvLines(std::string_view text) : rest_(text) {}

  [[nodiscard]] std::optional<std::string_view> next();

  /// The text not yet read, from the start of a line.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// Skips the next line, which is `bytes` long including its end.
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

/// Whether a line is blank or a comment.
[[nodiscard]] bool holds_nothing(std::string_view line);

/// The fields of a line without blanks around them.
[[nodiscard]] std::vector<std::string_view> split_fields(std::string_view line);

/// At most 40 characters of a file's text, in quotes, with non-printing bytes escaped.
[[nodiscard]] std::string quoted_text(std::string_view text);

/// The error for a line in a format that spreadsheets or editors write, or nothing.
[[nodiscard]] std::optional<core::Error> foreign_format(std::string_view line);

/// The error in a field that must be a number core::is_measurable(), or nothing.
[[nodiscard]] std::optional<core::Error> explain_field(std::string_view field,
                                                       std::string_view column,
                                                       std::string_view unit);

[[nodiscard]] bool is_utf16(std::string_view text);
[[nodiscard]] std::string_view without_byte_order_mark(std::string_view text);

}  // namespace rondure::record
