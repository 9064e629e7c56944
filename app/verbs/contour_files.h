#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "fit/contour/study.h"
#include "record/tasks/contour.h"

namespace rondure::app {

/// Reads "quantity=column[:unit[:sign]]", e.g. "x_error=X_FOLLOW:um:-1".
/// @return kBadOption for a quantity, unit or sign that does not exist.
[[nodiscard]] core::Result<record::ContourColumnTask> parse_contour_column(std::string_view text);

/// Reads a mapping file: {"columns": {"x_error": {"column": "X_FOLLOW", "unit": "um", "sign":
/// -1}}}.
/// @return kFile, kSyntax, kMissingKey, kUnknownKey, kWrongType, kBadOption with the JSON pointer.
[[nodiscard]] core::Result<std::vector<record::ContourColumnTask>> read_contour_mapping(
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

/// Reads a part with plans::read_trace() and read_gauge().
/// @return Their errors, with file and line.
[[nodiscard]] core::Result<ContourImport> read_contour_part(
    const ContourFiles& files, const std::vector<record::ContourColumnTask>& mapping);

}  // namespace rondure::app
