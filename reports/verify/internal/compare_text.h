#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rondure::reports {

// Pure functions for `rondure verify`: compare an export rendered again from the journal
// (`expected`) with the file on disk (`found`). Each returns the first difference in one sentence,
// or nothing when the two are equal.
//
// `tolerance` is absolute, in the unit of the numbers, >= 0. With 0 every byte must match. Above 0,
// for reports written on another kind of processor, two numbers that differ by no more are equal.

/// JSON: names the place by its JSON pointer, "/features/0/mz/deviation_um: the file says 7.43, the
/// journal gives 7.42"; also finds missing and added keys, text that is no longer JSON, and equal
/// values in different spelling. `expected` must be JSON.
[[nodiscard]] std::optional<std::string> first_json_difference(std::string_view expected,
                                                               std::string_view found,
                                                               double tolerance);

/// CSV with a header line: names the line of the file and the column.
[[nodiscard]] std::optional<std::string> first_csv_difference(std::string_view expected,
                                                              std::string_view found,
                                                              double tolerance);

/// Any text, such as HTML, byte for byte: names the line and shows a few words of both.
[[nodiscard]] std::optional<std::string> first_text_difference(std::string_view expected,
                                                               std::string_view found);

// The same for runs written by another version of the program: its wording and layout may differ,
// its numbers may not.

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
