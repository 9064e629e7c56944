#pragma once

#include <string>
#include <vector>

#include "app/verbs/contour_mapping.h"
#include "core/result.h"
#include "fit/contour/study.h"

namespace rondure::app {

/// Files of one part.
struct ContourFiles {
  std::string axes;
  std::string pin;
  std::string main;  ///< Empty: none.
};

/// A part as read from its files.
struct ContourImport {
  fit::ContourPart part;
  bool positions = false;  ///< Commanded and actual positions: their differences have a known sign.
};

/// Reads a part. Quantities without a mapping have the columns c_deg, c_error_deg, x_error_mm (with
/// d_cmd_mm, if it was recorded; or alpha_cmd_deg, d_cmd_mm, alpha_act_deg, d_act_mm, whose
/// differences are the errors); angle_deg and deviation_um of pin and main journal.
///
/// @return The errors of parse_series_csv(), with file and line; kMissingKey when both sets of axis
/// columns, or a column of the gauge, are missing.
[[nodiscard]] core::Result<ContourImport> read_contour_part(
    const ContourFiles& files, const std::vector<ContourColumn>& mapping);

}  // namespace rondure::app
