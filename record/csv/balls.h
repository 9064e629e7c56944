#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::record {

/// One ball measured at one angle of a rotary axis.
struct BallRow {
  std::string axis;                   ///< Name of the axis.
  std::optional<double> station_deg;  ///< Empty: the reference pose.
  std::string ball;
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d u_um = Eigen::Vector3d::Zero();  ///< Standard uncertainty of x, y, z.
  int direction = 0;     ///< +1, -1: approached forward or backward; 0: not stated.
  std::size_t line = 0;  ///< Line in the file, from 1.
};

/// Reads ball centres for the calibration of rotary axes: a header line with the columns
/// `axis,station_deg,ball,x_mm,y_mm,z_mm`, either `u_um` or `ux_um,uy_um,uz_um`, and optionally
/// `direction` (`+`, `-` or empty), in any order; then one row per ball. `station_deg` is a number
/// or the word `reference`. Blank lines, `#` comments, CRLF and byte order mark as in
/// parse_series_csv().
///
/// @param name  The file's name for `where` ("name:line").
/// @return kWrongUnit when one of these columns has another unit (coordinates are in mm, u in um;
/// other units are refused), kSyntax, kNotFinite, kNoPoints as read_points(). O(bytes).
[[nodiscard]] core::Result<std::vector<BallRow>> parse_ball_csv(std::string_view text,
                                                                std::string_view name);

}  // namespace rondure::record
