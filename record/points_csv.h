#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::record {

/// Points of a CSV file. z is 0 for a file with the columns x,y.
struct PointTable {
  int dimensions = 3;                    ///< 2 for "x,y", 3 for "x,y,z".
  std::vector<Eigen::Vector3d> points_mm;
};

/// Reads points from CSV text: a header line naming the columns (`x,y` or `x,y,z`, any order, mm),
/// then a row a point; `#` comments and blank lines are passed over; LF or CRLF; a UTF-8 byte order
/// mark is passed over. Anything else is kSyntax with `where` "name:line": another header, a missing
/// or extra field, text that is not a number, NaN or infinity (kNotFinite). An empty table is
/// kNoPoints. One pass; about the speed of std::from_chars.
///
/// @param name  The file's name for `where`.
[[nodiscard]] core::Result<PointTable> parse_points_csv(std::string_view text, std::string_view name);

/// The bytes of a file, or kFile with the system's reason.
[[nodiscard]] core::Result<std::string> read_file(const std::filesystem::path& path);

/// Writes a file whole or not at all (temporary name, flush to disk, rename); kFile otherwise.
[[nodiscard]] core::Result<void> write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace rondure::record
