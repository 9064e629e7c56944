#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "record/points/internal/units.h"
#include "record/points/points.h"

namespace rondure::record {

/// Points of a format that states its columns, in the unit of the file.
struct Cloud {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::size_t, 3>> triangles = {};  ///< Of STL; numbers of their points.
  std::string read;                                        ///< "PLY, little endian, double x y z".
  bool mesh = false;                                       ///< They are the vertices of triangles.
  bool single = false;                                     ///< Stored with 32 bits.
  std::size_t left_out = 0;                                ///< Rows with NaN.
  UnitLines units = {};                                    ///< As the file states it.
};

/// Hash of a place; a coordinate of -0.0 must have become 0.0.
struct PlaceHash {
  std::size_t operator()(const std::array<double, 3>& place) const {
    std::uint64_t out = 0;
    for (const double value : place) {
      out = (out ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15U;
      out ^= out >> 29U;
    }
    return out;
  }
};

/// The vertices of a PLY or STL file, or the points of a PCD file; nothing for another format. A
/// vertex that triangles share counts once, at its first place. The numbers that a head states are
/// compared with the length of the file before memory is taken.
/// @param name  Its ending tells a binary STL file that is cut off.
[[nodiscard]] std::optional<core::Result<Cloud>> read_cloud(std::string_view bytes,
                                                            std::string_view name);

/// The measured points of a DMIS file, of an I++ DME log or of a QIF document; nothing for another
/// text. Files of results, also those of CALYPSO, are refused.
[[nodiscard]] std::optional<core::Result<Cloud>> read_export(std::string_view text,
                                                             std::string_view name);

}  // namespace rondure::record
