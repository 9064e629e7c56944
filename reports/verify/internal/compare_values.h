#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::reports {

// Pure functions for `rondure verify`, when another version of the program wrote the run: its
// wording and layout may differ, its numbers may not. Each gives the first difference in one
// sentence, or nothing.

/// JSON: compares the numbers and the verdicts that stand in both under the same JSON pointer;
/// other words, and keys of one version only, are passed over. A number that is no longer given
/// (null) is a difference. `schema_version` is not compared. `expected` must be JSON.
[[nodiscard]] std::optional<std::string> compare_json_values(std::string_view expected,
                                                             std::string_view found,
                                                             double tolerance);

/// CSV with a header line: compares the columns that stand in both, row by row, fields that are no
/// numbers as text. Lines that begin with # are passed over.
[[nodiscard]] std::optional<std::string> compare_csv_values(std::string_view expected,
                                                            std::string_view found,
                                                            double tolerance);

}  // namespace rondure::reports
