#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "record/files.h"

namespace rondure::record {

/// Rows of a file that are of another feature than the one asked for.
struct OtherRows {
  std::string feature;
  std::size_t count = 0;
  std::size_t first_line = 0;  ///< In the file, from 1.
};

/// Points of a CSV file. z is 0 for a file with the columns x,y.
struct PointTable {
  int dimensions = 3;  ///< 2 for "x,y", 3 for "x,y,z".
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<int> layers = {};        ///< Layer of each point, from 0; empty: the file says none.
  std::vector<OtherRows> others = {};  ///< In the order of their first rows.

  /// Number of layers; 0 where the file says none.
  [[nodiscard]] int layer_count() const;
  /// Number of points of the layer that has the fewest; 0 where the file says none.
  [[nodiscard]] int least_points_per_layer() const;
};

/// Reads the points of one feature from CSV text: a header line naming the columns (`x,y` or
/// `x,y,z`, any order, mm), then one row per point. There may also be the columns `layer`, whole
/// numbers from 0 on without a gap, and `feature`, a name. Spaces around a field, blank lines,
/// lines that begin with `#` and a UTF-8 byte order mark are skipped; lines end with LF or CRLF.
/// One pass, about as fast as std::from_chars.
///
/// @param name     The file's name for `where`.
/// @param feature  Only rows with this name are taken. Empty: the file has no column `feature`.
/// @return  Or an error with `where` "name:line", the text found and the text expected: kSyntax for
///          another header, a missing or extra field or text that is not a number, kNotFinite for
///          NaN, infinity or a number beyond the range of double, kNoPoints for a table without
///          rows or without a row of that name; kMissingKey where the file holds several features
///          and none is named, kMeaning where one is named and there is no column for it;
///          kSampling for a missing layer.
[[nodiscard]] core::Result<PointTable> parse_feature_csv(std::string_view text,
                                                         std::string_view name,
                                                         std::string_view feature);

/// A section of a CSV file, as angles and deviations or as points.
struct ProfileTable {
  bool polar = true;  ///< Columns theta_deg,r_um; otherwise x,y.
  std::vector<Eigen::Vector2d>
      rows;  ///< (theta, r) in deg and um, or (x, y) in mm: as in the file.
};

/// Reads a section from CSV text: columns `theta_deg,r_um` or `x,y` (mm), in any order. Otherwise
/// as parse_feature_csv().
[[nodiscard]] core::Result<ProfileTable> parse_profile_csv(std::string_view text,
                                                           std::string_view name);

}  // namespace rondure::record
