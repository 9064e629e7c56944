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

/// A part as its files hold it.
struct ContourImport {
  fit::ContourPart part;
  bool positions = false;  ///< Commanded and actual positions: their differences need no sign.
};

/// Reads a part. Quantities without a mapping have the columns c_deg, c_error_deg, x_error_mm (with
/// d_cmd_mm, if it was recorded; or alpha_cmd_deg, d_cmd_mm, alpha_act_deg, d_act_mm, whose
/// differences are the errors); angle_deg
/// and deviation_um of pin and main journal.
///
/// @return What parse_series_csv() refuses, with file and line; kMissingKey where neither set of
///         axis columns, or a column of the gauge, is there.
[[nodiscard]] core::Result<ContourImport> read_contour_part(
    const ContourFiles& files, const std::vector<ContourColumn>& mapping);

}  // namespace rondure::app
