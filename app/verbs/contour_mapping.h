#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace rondure::app {

/// What the files of a control or a gauge call a quantity, in which unit, with which sign.
struct ContourColumn {
  std::string quantity;  ///< One of those below.
  std::string column;    ///< As the header line spells it.
  std::string unit;      ///< Empty: that of the quantity without a mapping.
  double sign = 1.0;     ///< 1 or -1.
};

/// A quantity of `fit contour`, with the column it has without a mapping; the name of that column
/// carries its unit.
struct ContourQuantity {
  std::string_view name;
  std::string_view column;
};
/// c, c_error, x_error (or alpha_cmd, alpha_act, d_cmd, d_act) of the control; angle, deviation,
/// main_angle, main_deviation of the gauge.
[[nodiscard]] const ContourQuantity& contour_quantity(std::string_view name);

/// How a quantity is read from a file.
struct ContourReading {
  std::string column;
  double factor = 1.0;  ///< To rad or mm, with the sign.
};
[[nodiscard]] ContourReading reading_of(const ContourQuantity& quantity,
                                        const std::vector<ContourColumn>& mapping);

/// Reads "quantity=column[:unit[:sign]]", e.g. "x_error=X_FOLLOW:um:-1".
/// @return kBadOption for a quantity, unit or sign that does not exist.
[[nodiscard]] core::Result<ContourColumn> parse_contour_column(std::string_view text);

/// Reads a mapping file: {"columns": {"x_error": {"column": "X_FOLLOW", "unit": "um", "sign":
/// -1}}}.
/// @return kFile, kSyntax, kMissingKey, kUnknownKey, kWrongType, kBadOption with the JSON pointer.
[[nodiscard]] core::Result<std::vector<ContourColumn>> read_contour_mapping(
    const std::string& file);

}  // namespace rondure::app
