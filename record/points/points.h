#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"
#include "record/files.h"

namespace rondure::record {

enum class LengthUnit { kMm, kUm, kCm, kM, kInch };
RONDURE_WORDS(LengthUnit, {kMm, "mm"}, {kUm, "um"}, {kCm, "cm"}, {kM, "m"}, {kInch, "inch"});

/// What the layers of a cloud are: a column of its file, heights along z, or nothing.
enum class LayersFrom { kColumn, kHeights, kNone };
RONDURE_WORDS(LayersFrom, {kColumn, "column"}, {kHeights, "heights"}, {kNone, "none"});

/// What points are: centres of the tip, or places of the surface.
enum class PointsAre { kTipCentres, kSurface };
RONDURE_WORDS(PointsAre, {kTipCentres, "tip-centres"}, {kSurface, "surface"});

/// Whether the vertices of a mesh may carry a verdict.
enum class MeshUse { kAccepted };
RONDURE_WORDS(MeshUse, {kAccepted, "accepted"});

/// What a plan says of rows of a file that none of its features takes.
enum class UntakenRows { kLeftOut };
RONDURE_WORDS(UntakenRows, {kLeftOut, "left-out"});

/// What is known of a points file beforehand. What is left out, the file shows, or it is refused.
struct PointsOptions {
  std::string feature;                    ///< Rows to take; empty: the file has one feature.
  std::vector<std::string> columns = {};  ///< Of x, y and z: numbers from 1, or names in the head.
  std::optional<LengthUnit> unit = {};
  std::optional<LayersFrom> layers = {};
};

/// Rows of a file that are of another feature than the one asked for.
struct OtherRows {
  std::string feature;
  std::size_t count = 0;
  std::size_t first_line = 0;  ///< In the file, from 1.
};

/// Rows with the coordinates, and the layer, of an earlier row. They take no part.
struct RepeatedRows {
  std::size_t count = 0;
  std::size_t first = 0;     ///< The first of them: a row of the feature in the file, from 0.
  std::size_t original = 0;  ///< The row that it repeats.
};

/// Points of a file. z is 0 for a file that has none.
struct PointTable {
  int dimensions = 3;  ///< 2 for x and y.
  std::vector<Eigen::Vector3d> points_mm;
  std::vector<int> layers = {};        ///< Layer of each point, from 0; empty: the file says none.
  std::vector<std::size_t> rows = {};  ///< In the file, of each point; empty: none is left out.
  std::optional<RepeatedRows> repeated = {};
  std::vector<OtherRows> others = {};  ///< In the order of their first rows.
  bool unit_stated = false;            ///< By the file or beforehand; otherwise mm is assumed.
  bool mesh = false;                   ///< Vertices of triangles, computed from points.
  std::string read = {};               ///< What was taken for what, in one line.

  /// Row of a point among those of the feature in the file, from 0.
  [[nodiscard]] std::size_t row(std::size_t point) const {
    return rows.empty() ? point : rows[point];
  }
  /// Number of layers; 0 where the file says none.
  [[nodiscard]] int layer_count() const;
  /// Number of points of the layer that has the fewest; 0 where the file says none.
  [[nodiscard]] int least_points_per_layer() const;
};

/// Reads the points of one feature from the bytes of a file.
///
/// Text: UTF-8, UTF-16 or Windows-1252; lines end with LF, CR LF or CR; `#` begins a comment;
/// fields are separated by tabs, semicolons, bars, commas or blanks, numbers have a decimal point
/// or comma. A head line names the columns (`x`, `X [mm]`, `X-Ist`, ..., beside them `layer`, whole
/// numbers from 0 or 1 on without a gap, and `feature`); others are passed over. Without one there
/// are exactly two or three columns of numbers. What can be read in two ways is refused. One pass,
/// about as fast as std::from_chars, which gives every number. A row that repeats the coordinates
/// and the layer of an earlier one exactly is no second measurement: it is left out and counted.
///
/// @param name  The file's name for `where`; its ending tells XYZ files.
/// @return  Or an error with `where` "name:line", the text found and the text expected: kSyntax for
///          another format, a missing or extra field or text that is not a number, kNotFinite for
///          NaN, infinity or a number beyond the range of double, kUnits for an unknown unit,
///          kNoPoints for a table without rows or without a row of that name; kMissingKey where the
///          file holds several features and none is named, kMeaning where one is named and there
///          is no column for it; kSampling for a missing layer, and for heights that form none.
[[nodiscard]] core::Result<PointTable> read_points(std::string_view bytes, std::string_view name,
                                                   const PointsOptions& options = {});

/// A section of a text file, as angles and deviations or as points.
struct ProfileTable {
  bool polar = true;                  ///< Columns theta_deg,r_um; otherwise x,y.
  std::vector<Eigen::Vector2d> rows;  ///< (theta, r) in deg and um, or (x, y) in mm.
};

/// Reads a section from text: a head line names the columns `theta_deg` and `r_um`, or x and y.
/// Otherwise as read_points(); a unit is that of x and y, layers have no part in it.
[[nodiscard]] core::Result<ProfileTable> read_profile(std::string_view bytes, std::string_view name,
                                                      const PointsOptions& options = {});

}  // namespace rondure::record
