#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/points/internal/head.h"
#include "record/points/internal/units.h"

namespace rondure::record {

/// How numbers and fields are told apart.
struct Notation {
  char separator;  ///< ' ' for any number of blanks.
  char decimal;
};

/// Takes a line off a text. Lines end with LF or CR LF, or, where there is no LF, with CR.
struct Lines {
  std::string_view rest;
  char end = '\n';
  std::size_t number = 0;  ///< Of the line taken last, from 1.

  explicit Lines(std::string_view text) : rest(text) {
    if (text.find('\n') == std::string_view::npos) end = '\r';
  }
  std::string_view take() {
    ++number;
    const std::size_t stop = std::min(rest.find(end), rest.size());
    std::string_view line = rest.substr(0, stop);
    rest.remove_prefix(std::min(stop + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
};

/// How a table is written, and where its rows begin.
struct TableLayout {
  Notation notation;
  std::vector<Role> roles;  ///< One a field.
  std::array<std::string, 3> names;
  UnitLines units = {};
  Lines rows{std::string_view()};
  bool elements = false;     ///< A feature without a name is that of the row above.
  bool by_point = false;     ///< The names of points show their features: "CYL1.P7".
  std::string heading = {};  ///< Feature that a line of text above the rows names.
  std::optional<std::size_t> announced = {};  ///< Rows that the line above them states.
  std::optional<std::size_t> at_least = {};   ///< Rows that a text above them states.

  [[nodiscard]] bool has(Role role) const { return std::ranges::find(roles, role) != roles.end(); }
};

/// The layouts that a text may have, the best one first.
/// @return  Errors as read_points().
[[nodiscard]] core::Result<std::vector<TableLayout>> find_layouts(std::string_view text,
                                                                  std::string_view name,
                                                                  const PointsOptions& options,
                                                                  const WantedColumns& wanted);

/// Reads a number as std::from_chars does, to the same bits. A decimal comma stands between digits:
/// "1," may be a number and a separator.
[[nodiscard]] std::from_chars_result read_number(const char* at, const char* end, char decimal,
                                                 double& value);

/// "2,3,4": the numbers of the columns of x, y and z, in lines that begin with more fields.
[[nodiscard]] std::string column_numbers(const std::vector<Role>& roles, std::size_t more = 0);

}  // namespace rondure::record
