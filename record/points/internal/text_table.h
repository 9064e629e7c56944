#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "record/points/internal/head.h"

namespace rondure::record {

/// The rows of a text table, in the unit of the file.
struct TextTable {
  int dimensions = 2;
  std::vector<Eigen::Vector3d> rows;
  std::vector<int> layers;         ///< As in the file; empty without that column.
  std::string feature;             ///< That of the rows; empty without that column.
  std::vector<OtherRows> others;   ///< Rows of other features.
  std::optional<LengthUnit> unit;  ///< As the file states it.
  std::string read;                ///< "semicolon, decimal comma, X-Ist Y-Ist Z-Ist".
  std::size_t left_out = 0;        ///< Rows without values.
  std::size_t below = 0;           ///< Lines of text below the rows.
};

/// Finds how a table is written, and reads its rows.
/// @return  Errors as read_points().
[[nodiscard]] core::Result<TextTable> read_text_table(std::string_view text, std::string_view name,
                                                      const PointsOptions& options,
                                                      const WantedColumns& wanted);

}  // namespace rondure::record
