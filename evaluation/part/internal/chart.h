#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/uncertainty/cloud.h"
#include "evaluation/uncertainty/internal/error_modes.h"

namespace rondure::evaluation {

/// The points of a feature as the form model takes them, whatever its shape: an angle, a position
/// along the generatrix and a deviation along the normal.
struct Chart {
  FormCloud cloud;
  std::vector<Eigen::Vector3d> normals;  ///< Unit vectors along which the deviations count.
  std::vector<Eigen::Vector3d> tips_mm;  ///< Tip centres, machine frame.
};

/// The chart of some rows of the cloud of a feature, about its least-squares surface. The times of
/// its points are even, and their pose is the first.
/// @param rows     Ascending.
/// @param tips_mm  One for each row of the cloud.
/// @return  kMeaning for spheres and analyses; the errors of the fits.
[[nodiscard]] core::Result<Chart> chart_of(const FeatureResult& result,
                                           std::span<const std::size_t> rows,
                                           std::span<const Eigen::Vector3d> tips_mm);

/// The points of a chart for the influences that act on them.
/// @param middle_mm  The point from which the part grows.
[[nodiscard]] std::vector<TouchedPoint> touched_points(const Chart& chart,
                                                       const Eigen::Vector3d& middle_mm);

}  // namespace rondure::evaluation
