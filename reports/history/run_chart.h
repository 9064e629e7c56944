#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units.h"
#include "record/archive/archive.h"
#include "reports/history/capability.h"

namespace rondure::reports {

/// The results of one characteristic in the order of time, with their statistics. One chart only
/// has comparable results: same part, feature, characteristic, parameter, reference, filter,
/// sampling and unit, all real or all simulated.
struct RunChart {
  std::vector<record::ArchivedResult> results;  ///< Oldest first; each has a value and is not void.
  std::optional<double> upper_limit_mm;         ///< The tolerance of the newest result.
  std::optional<double> lower_limit_mm;         ///< Its lower limit, of a size.
  std::optional<ControlLimits> limits;
  std::vector<std::size_t> beyond;  ///< Results beyond a control limit.
  std::size_t allowed_beyond = 0;   ///< Number expected beyond in a stable process: 0.27 %.
  std::optional<Capability> capability;
  /// "CpkU" in statistical control, otherwise "PpkU"; "Cpk", "Ppk" between two limits, "CpkL",
  /// "PpkL" above a lower one.
  std::string index_name;
  /// Sentences on results left out, missing statistics and mixed conditions.
  std::vector<core::Phrase> notes;
};

/// Makes the chart of the newest result's characteristic; empty when no result has a value.
/// @param newest_first  In the order of Archive::newest().
[[nodiscard]] RunChart run_chart_of(std::span<const record::ArchivedResult> newest_first);

/// Range of the value axis of a drawing.
struct ChartRange {
  double low_mm = 0.0;
  double high_mm = 1.0;
  /// A tolerance far above would press the results into one line; it is then only stated.
  bool limit_shown = false;
};
[[nodiscard]] ChartRange range_of(const RunChart& chart);

/// The unit that the numbers of an archive are written in: it keeps lengths in mm, angles in mrad.
[[nodiscard]] core::ValueUnit unit_of_archive(std::string_view unit);
[[nodiscard]] core::ValueUnit unit_of(const RunChart& chart);

/// The value of a result in mm; of an angle in mrad, here and in all statistics.
[[nodiscard]] std::vector<double> values_of(const RunChart& chart);

/// "PpkU 1.23, at least 1.05 with 95 % confidence; log-normal, ..."; empty without an index.
[[nodiscard]] core::Phrase capability_in_words(const RunChart& chart);

}  // namespace rondure::reports
