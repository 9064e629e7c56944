#pragma once

#include <span>
#include <string_view>

#include "core/result.h"
#include "record/run_record.h"
#include "record/tasks/contour.h"

// Files of a control and of a gauge, brought to the columns and units of a contour.

namespace rondure::plans {

using ContourColumns = std::span<const record::ContourColumnTask>;

/// Whether a column has a unit of its quantity and a scale.
/// @return kBadOption.
[[nodiscard]] core::Result<void> check_column(const record::ContourColumnTask& column);

/// A trace of the control.
struct ContourTrace {
  record::Series series;  ///< c_deg, c_error_deg, x_error_mm; d_cmd_mm where it was recorded.
  /// Of commanded and actual positions: their differences are actual minus command.
  bool positions = false;
};

/// Reads a trace: c, c_error and x_error (with d_cmd), or alpha_cmd, d_cmd, alpha_act and d_act.
/// Without a column the name of a quantity is that of the series, or alpha_cmd_deg, d_cmd_mm,
/// alpha_act_deg, d_act_mm.
/// @param name  Of the file, for `where`.
/// @return The errors of parse_series_csv(); kMissingKey when both sets of columns are incomplete.
[[nodiscard]] core::Result<ContourTrace> read_trace(std::string_view text, std::string_view name,
                                                    ContourColumns columns);

/// Reads a contour of the gauge: angle_deg, deviation_um.
/// @param main  Of a main journal, whose columns may be named otherwise.
/// @return The errors of parse_series_csv().
[[nodiscard]] core::Result<record::Series> read_gauge(std::string_view text, std::string_view name,
                                                      bool main, ContourColumns columns);

}  // namespace rondure::plans
