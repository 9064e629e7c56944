#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace rondure::reports {

// Pure functions for `rondure verify`, for runs written by another version of the program: its
// wording and layout may differ, its numbers may not. Each returns the first difference in one
// sentence, or nothing.

/// JSON: compares the numbers and the verdicts that both have under the same JSON pointer; other
/// words, and keys of one version only, are ignored. A number that has become null is a difference.
/// `schema_version` is not compared. `expected` must be JSON.
[[nodiscard]] std::optional<std::string> compare_json_values(std::string_view expected,
                                                             std::string_view found,
                                                             double tolerance);

/// CSV with a header line: compares the columns that both have, row by row; fields that are not
/// numbers are compared as text. Lines that begin with # are ignored.
[[nodiscard]] std::optional<std::string> compare_csv_values(std::string_view expected,
                                                            std::string_view found,
                                                            double tolerance);

}  // namespace rondure::reports
