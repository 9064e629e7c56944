#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/circle.h"

namespace rondure::fit {

/// The points of a feature, one element for each planned layer.
using Layers = std::span<const std::vector<Eigen::Vector3d>>;

/// A layer projected along an axis, with its least-squares circle.
struct Section {
  std::vector<Eigen::Vector2d> points_mm;  ///< From the axis, in the frame of across() [mm].
  std::vector<double> heights_mm;          ///< Along the axis, from its point [mm].
  LsCircle circle;                         ///< In the frame of `points_mm`.
  /// Centre of the circle at the mean height, in the frame of the data: a point of the extracted
  /// median line [mm].
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
};

/// Projects each layer along the axis and fits its circle.
/// @return The sections in the order of the layers; kNoPoints (no layer), the errors of ls_circle()
///         and kSampling for a layer thicker than 0.5 mm along the axis, whose circle would be that
///         of several sections; `what` names the layer.
/// Source: methods, drawing section 1.
[[nodiscard]] core::Result<std::vector<Section>> sections_across(Layers layers_mm,
                                                                 const Axis& axis);

/// Groups the points of a file without layers: a new section begins where neighbouring heights
/// along the axis differ by more than 0.5 mm.
/// @return The rows of each section, ascending; the lowest section first.
/// Source: methods, drawing section 1.
[[nodiscard]] std::vector<std::vector<std::size_t>> rows_by_height(SpacePoints points_mm,
                                                                   const Axis& axis);

/// The direction along which the points of each layer lie closest together: the normal of the
/// layers, and the axis of a turned surface as nearly as these are square to it.
///
/// @param layers  Layer of each point.
/// @return Nothing where the points of the layers leave it open, as those on narrow arcs or along
///         lines do.
[[nodiscard]] std::optional<Eigen::Vector3d> layer_normal(SpacePoints points_mm,
                                                          std::span<const int> layers);

/// The centres of sections.
[[nodiscard]] std::vector<Eigen::Vector3d> median_line(std::span<const Section> sections);

}  // namespace rondure::fit
