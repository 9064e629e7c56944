#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace rondure::record {

using Cells = std::vector<std::string_view>;

/// The fields of a line without blanks and quotes around them; no more than 1001.
/// @param separator  ' ' stands for any number of blanks.
[[nodiscard]] std::vector<std::string_view> fields_of(std::string_view line, char separator);

/// The number of fields up to the last one that is not empty.
[[nodiscard]] std::size_t filled_fields(const std::vector<std::string_view>& fields);

/// The place of the sign that ends the quotes with which a text begins; npos where none hold a
/// field together. Single quotes do only where the field ends with them.
[[nodiscard]] std::size_t closing_quote(std::string_view text, char separator);

[[nodiscard]] std::string lower_case(std::string_view text);
/// Whether a field is the number that is none: "NaN", "-nan(ind)", "1.#QNAN".
[[nodiscard]] bool is_nan(std::string_view field);
/// A word that is a whole number, or nothing.
[[nodiscard]] std::optional<std::size_t> count_of(std::string_view word);
/// The place, from 0, that a column named by a number has.
[[nodiscard]] std::optional<std::size_t> place_of_column(std::string_view column);

[[nodiscard]] std::string_view name_of_separator(char separator);

/// Whether fields are a row of so many columns: empty ones may follow.
[[nodiscard]] bool agrees(const Cells& fields, std::size_t columns);

/// Says that a line has not as many fields as there are columns.
[[nodiscard]] core::Error wrong_count(std::string_view line, char separator, std::size_t columns);

[[nodiscard]] core::Error at_line(core::Error error, std::string_view name, std::size_t line);

/// "1,5" as a reader takes it for one number or for two.
[[nodiscard]] std::string both_readings(std::string_view line);

}  // namespace rondure::record
