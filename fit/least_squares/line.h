#pragma once

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// A least-squares straight line in space.
struct LsLine {
  Axis axis;  ///< Through the mean of the points.
  /// Diameter of the smallest cylinder about this axis that holds all points: twice the largest
  /// distance [mm]. Not less than the minimum-zone straightness, for which the axis may move.
  double deviation_mm = 0.0;
  double rms_mm = 0.0;  ///< Root mean square of the distances from the axis [mm].
};

/// Fits the least-squares line: minimises the sum of squared orthogonal distances. The axis passes
/// through the mean along the first principal axis of the points. Closed form, followed by one step
/// across the axis, so that small distances keep their digits on a long line.
///
/// @param points_mm  n >= 2, any order and place [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints (fewer than 2 different points), kRank (no
///         direction has the largest extent). Two passes.
/// Source: K. Pearson, Philosophical Magazine 2 (1901) 559-572.
[[nodiscard]] core::Result<LsLine> ls_line(SpacePoints points_mm);

/// Straightness of a median line (ISO 12780-1, extracted median line of a cylinder: ISO 14660-2):
/// deviation of the centres of the sections from their least-squares line.
///
/// @param section_centers_mm  Centres of the least-squares circles, one per section; n >= 3.
/// @return as ls_line(); kTooFewPoints below 3, as two centres are always on a line.
[[nodiscard]] core::Result<LsLine> median_line_straightness(
    std::span<const Eigen::Vector3d> section_centers_mm);

}  // namespace rondure::fit
