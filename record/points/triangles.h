#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "record/points/points.h"

namespace rondure::record {

/// A surface of triangles.
struct Triangles {
  std::vector<Eigen::Vector3d> points_mm;           ///< Each different place once.
  std::vector<std::array<std::size_t, 3>> corners;  ///< Numbers of three points for each triangle.
};

/// Reads the triangles of an STL file, text or binary.
/// @param name  Its ending tells a binary file that is cut off.
/// @param unit  Of its numbers; STL states none.
/// @return kSyntax for another format, a file that is cut off or one without triangles, kNotFinite
///         for a corner that is no number within 1e9; `where` names file and line.
[[nodiscard]] core::Result<Triangles> read_triangles(std::string_view bytes, std::string_view name,
                                                     LengthUnit unit);

}  // namespace rondure::record
