#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/result.h"
#include "record/run_record.h"

namespace rondure::record {

/// A column that an analysis reads. The name carries the unit: "alpha_deg", "H1_um".
struct WantedColumn {
  std::string_view name;
  bool required = true;
  /// Words that stand for 0, 1, ...; empty: numbers.
  std::span<const std::string_view> words = {};
};

/// The name of a wanted column in a file that uses another one.
struct ColumnName {
  std::string wanted;
  std::string in_file;
  bool converted = false;  ///< The reader brings it from another unit to that of the wanted one.
};

/// The column that every table may have beside the wanted ones: the temperature of the part.
inline constexpr std::string_view kTemperatureColumn = "temperature_degC";

/// Reads a table of numbers: a header line with the names of the columns, in any order, then one
/// row per line. Blank lines, `#` comments and a UTF-8 byte order mark are passed over; lines end
/// with LF or CRLF.
///
/// Without `names` every column must be a wanted one. With `names` a column is found under its name
/// in the file, and other columns are skipped.
///
/// kTemperatureColumn may stand in any table, or one value for all rows in a comment above the
/// header: "# temperature_degC: 20.3". It comes last in the result.
///
/// @param name  The file's name for `where` ("name:line").
/// @return  The wanted columns that the file has, in the order of `wanted`; kWrongUnit for a column
///          whose unit differs from that of the wanted column with the same name, or that stands
///          for it; kSyntax,
///          kNotFinite, kNoPoints as read_points(); kBadOption for a name in `names` that is
///          not wanted. O(bytes).
[[nodiscard]] core::Result<Series> parse_series_csv(std::string_view text, std::string_view name,
                                                    std::span<const WantedColumn> wanted,
                                                    std::span<const ColumnName> names = {});

}  // namespace rondure::record
