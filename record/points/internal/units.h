#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/points/points.h"

namespace rondure::record {

/// Words of a line in lower case, without the signs between them.
using NameWords = std::vector<std::string>;
[[nodiscard]] NameWords words_in(std::string_view text);

template <class List>
[[nodiscard]] bool is_one_of(const List& list, std::string_view word) {
  return std::ranges::find(list, word) != list.end();
}

[[nodiscard]] double mm_in(LengthUnit unit);

/// The unit of that name, in lower case.
[[nodiscard]] std::optional<LengthUnit> unit_named(std::string_view word);
/// The unit in a field that holds nothing else.
[[nodiscard]] std::optional<LengthUnit> unit_of_field(std::string_view field);
/// Whether a column of that name holds the unit of each row.
[[nodiscard]] bool names_unit(std::string_view word);

/// The unit that a line of text states: "Units: inch".
[[nodiscard]] std::optional<LengthUnit> unit_in_text(std::string_view line);
/// That the unit of a file is in doubt, and what settles it.
[[nodiscard]] core::Error unit_error(const std::string& fault);
/// That columns are in several units, which no option settles.
[[nodiscard]] std::string columns_differ(LengthUnit unit, LengthUnit other);
/// Whether a head line names angles and radii.
[[nodiscard]] bool is_polar(std::string_view line);
/// The number of points that a line states in words: "Number of points: 180".
[[nodiscard]] std::optional<std::size_t> points_in_text(std::string_view line);

/// What a file states of its unit, line by line.
struct UnitLines {
  std::optional<LengthUnit> unit = {};
  std::optional<core::Error> contradiction = {};  ///< Of two lines; the first one counts.
  std::optional<core::Error> doubtful = {};  ///< Of a line that may state a unit: no matter where
                                             ///< another one states it.
  std::string_view before = {};              ///< "Units:", whose unit stands in the next line.

  /// Takes a line of text.
  /// @param below  Points stand above, which were read in `unit`, or in mm.
  void take(std::string_view line, std::string_view name, std::size_t number, bool below = false);
  /// Takes a unit that is stated at a place.
  void state(LengthUnit stated, const std::string& where, bool below = false);
  /// Why the unit must be given.
  [[nodiscard]] std::optional<core::Error> fault() const;
};

}  // namespace rondure::record
