#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"
#include "fit/wheel/centers.h"

namespace rondure::fit {

/// Limits of find_outliers().
struct OutlierOptions {
  double scales = 5.0;  ///< Points beyond this many scales are flagged; >= 5, as lobes are form.
  double least_scale_mm = 1e-4;  ///< Floor of the scale [mm], > 0.
};

/// A point that was left out.
struct DroppedPoint {
  std::size_t row = 0;
  double deviation_mm = 0.0;  ///< Deviation from the median radius about the median centre.
};

/// Points that are not on the surface of the wheel.
struct Outliers {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();  ///< Component-wise median of the centres.
  std::vector<double> deviations_mm;  ///< Deviations of all points from the median radius.
  double scale_mm = 0.0;              ///< 1.4826 median |deviation|.
  std::vector<DroppedPoint> dropped;  ///< In the order of rows.
  std::vector<core::Error> warnings;  ///< kOutliers, kLocalForm.
};

/// Finds isolated points far from the circle. Flagged points with at most two others between them
/// form a run; a run of three or more is form (wear, a flat) and is kept.
///
/// @return kBadOption; kOutliers if more than a quarter of the points, or so many that fewer than 8
///         remain, would be dropped.
/// Source: methods, wheel section 7.
[[nodiscard]] core::Result<Outliers> find_outliers(PlanePoints points_mm,
                                                   std::span<const FourPointCenter> centers,
                                                   const OutlierOptions& options = {});

}  // namespace rondure::fit
