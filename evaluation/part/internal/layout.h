#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/error.h"
#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "fit/geometry/axis.h"
#include "record/tasks/surface.h"

// Private to the room: what is true of a surface whatever a trial moves.

namespace rondure::evaluation {

/// A section before a characteristic restricts it.
struct SectionRows {
  int layer = 0;
  std::optional<int> pass = {};
  double part_z_mm = 0.0;         ///< Mean; of a plane the mean radius. Of all its points.
  std::vector<std::size_t> rows;  ///< Without windows.
  bool gap = false;               ///< Windows take a part of it, not all.
  bool dense = false;             ///< See carries_lowest_cutoff().
};

/// Windows, outliers and sections of a cloud as measured.
struct SurfaceLayout {
  std::optional<core::Error> failure;     ///< Why no characteristic can be computed.
  std::vector<bool> kept;                 ///< By row: outside all windows.
  std::vector<LeftOut> windows;           ///< Rows in windows, ascending.
  std::vector<SectionRows> sections;      ///< Lowest (innermost) first; some may be empty.
  std::vector<double> part_z_mm;          ///< By row.
  std::optional<core::Error> no_heights;  ///< Why part z is not known.
  fit::Axis axis;                         ///< Least squares, without windows.
  std::vector<std::size_t> outlying;      ///< Rows beyond five scales, farthest first.
  std::vector<double> off_mm;             ///< How far each of these is off.
  std::optional<core::Error> too_many;    ///< Why the outlier rule cannot be applied.
  std::optional<core::Error> form;        ///< Why the outlying points are form: neighbours lie off.
  std::vector<core::Error> warnings;
  /// Why a cloud without layers has no sections: its points follow no circles (a helix).
  std::optional<core::Error> no_sections = {};
  bool as_measured = true;  ///< without_rows() took no row.
};

[[nodiscard]] SurfaceLayout layout_of(const FeatureResult& feature);

/// Whether the layers of the cloud are known; a file without them is parted by heights.
[[nodiscard]] bool has_layers(const FeatureResult& feature);
/// Whether the points of a section lie in one plane across the axis to 0.5 mm.
/// @pre Not empty.
/// @return kSampling with the layer and its thickness. A circle that is seen along z has any.
[[nodiscard]] core::Result<void> check_thickness(const FeatureResult& feature, int layer,
                                                 std::span<const double> heights_mm);

/// Least-squares feature of some points: of a plane its normal, of a sphere part z through its
/// centre.
struct FittedSurface {
  fit::Axis axis;
  std::vector<double> off_mm;  ///< Of each point, but for a constant; empty unless asked for.
};
enum class Deviations { kSkip, kCompute };
/// @param near  Start direction; of a plane one out of the material. None: not known.
[[nodiscard]] core::Result<FittedSurface> fitted(const FeatureResult& feature,
                                                 std::span<const Eigen::Vector3d> points_mm,
                                                 const std::optional<Eigen::Vector3d>& near,
                                                 Deviations deviations);

}  // namespace rondure::evaluation
