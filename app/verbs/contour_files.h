#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "fit/contour/study.h"

namespace rondure::app {

/// Name, unit and sign of a quantity in the files of a controller or a gauge.
struct ContourColumn {
  /// c, c_error, x_error (or alpha_cmd, alpha_act, d_cmd, d_act) of the controller; angle,
  /// deviation, main_angle, main_deviation of the gauge.
  std::string quantity;
  std::string column;  ///< Name in the header line.
  std::string unit;    ///< Empty: the unit of the quantity without a mapping.
  double sign = 1.0;   ///< 1 or -1.
};

/// Reads "quantity=column[:unit[:sign]]", e.g. "x_error=X_FOLLOW:um:-1".
/// @return kBadOption for a quantity, unit or sign that does not exist.
[[nodiscard]] core::Result<ContourColumn> parse_contour_column(std::string_view text);

/// Reads a mapping file: {"columns": {"x_error": {"column": "X_FOLLOW", "unit": "um", "sign":
/// -1}}}.
/// @return kFile, kSyntax, kMissingKey, kUnknownKey, kWrongType, kBadOption with the JSON pointer.
[[nodiscard]] core::Result<std::vector<ContourColumn>> read_contour_mapping(
    const std::string& file);

/// Files of one part.
struct ContourFiles {
  std::string axes;
  std::string pin;
  std::string main;  ///< File of the main journal; empty: none.
};

/// A part read from its files.
struct ContourImport {
  fit::ContourPart part;
  /// Contains commanded and actual positions: their differences have a known sign.
  bool positions = false;
};

/// Reads a part. Quantities without a mapping have the columns c_deg, c_error_deg, x_error_mm (with
/// d_cmd_mm, if it was recorded; or alpha_cmd_deg, d_cmd_mm, alpha_act_deg, d_act_mm, whose
/// differences are the errors); angle_deg and deviation_um of pin and main journal.
///
/// @return The errors of parse_series_csv(), with file and line; kMissingKey when both sets of axis
///         columns, or a column of the gauge, are missing.
[[nodiscard]] core::Result<ContourImport> read_contour_part(
    const ContourFiles& files, const std::vector<ContourColumn>& mapping);

}  // namespace rondure::app
