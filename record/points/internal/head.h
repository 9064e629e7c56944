#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "record/points/internal/fields.h"
#include "record/points/points.h"

namespace rondure::record {

/// The text of a file as UTF-8, without a byte order mark.
struct DecodedText {
  std::string converted;      ///< Owner of the text; empty where the bytes are UTF-8.
  std::string_view encoding;  ///< "UTF-16 LE"; empty for UTF-8.

  /// @param bytes  Those that were decoded.
  [[nodiscard]] std::string_view text(std::string_view bytes) const;
};

/// Decodes UTF-8, UTF-16 (by its byte order mark, or by the zero bytes of its digits) and, where
/// the bytes are neither, Windows-1252: a wrong guess can only hurt names.
/// @return  kSyntax for UTF-32 and for zero bytes elsewhere, with `where` "name:line".
[[nodiscard]] core::Result<DecodedText> decode_text(std::string_view bytes, std::string_view name);

/// What a column holds.
enum class Role : std::uint8_t { kX, kY, kZ, kLayer, kFeature, kUnit, kCount, kNone };

/// Columns that a table may have. The coordinates of a profile are angle and deviation.
struct WantedColumns {
  std::array<std::string_view, 3> names = {"x", "y", "z"};  ///< For messages.
  std::array<std::string_view, 3> units = {"mm", "mm", "mm"};
  bool polar = false;
  bool profile = false;  ///< Of a section, from which no row may be left out in silence.
  std::string_view list = "x,y or x,y,z, beside them layer and feature";
};

/// A line that names columns.
struct Head {
  std::vector<Role> roles;         ///< One a field, up to the last that is not empty.
  std::optional<LengthUnit> unit;  ///< Of the coordinates.
  std::array<std::string, 3> names;
  std::vector<std::size_t> elements;  ///< Columns called "Element", "Group" or similar.
  std::optional<core::Error> fault;   ///< Why it cannot be used.
};

/// The head that the fields are, or nothing where they name fewer than two coordinates.
[[nodiscard]] std::optional<Head> head_of(const std::vector<std::string_view>& fields,
                                          const PointsOptions& options,
                                          const WantedColumns& wanted);

}  // namespace rondure::record
