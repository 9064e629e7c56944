#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rondure::record {

/// A column of the first rows of a table.
using ColumnText = std::vector<std::string_view>;

/// Whether a column called "Element" names features: most rows have the name of another one, or
/// none, below it. Otherwise each has the name of its point.
[[nodiscard]] bool names_features(const ColumnText& column);

/// Whether a column counts the rows: few others than whole numbers, most of which rise.
[[nodiscard]] bool counts_rows(const ColumnText& column);

/// "CYL1" of the point "CYL1.P7", "cone2" of "cone2_7"; "" of other names. Circles, planes and
/// layers may be parts of one feature.
[[nodiscard]] std::string_view feature_of_point(std::string_view name);

/// "zylinder2" of the line "# Zylinder 2"; "" of other lines.
[[nodiscard]] std::string feature_of_heading(std::string_view line);

}  // namespace rondure::record
