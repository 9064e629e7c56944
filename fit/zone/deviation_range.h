#pragma once

#include <optional>

#include <Eigen/Core>

#include "fit/geometry/points.h"
#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Least and greatest deviation about the circles that are equally good as a reference [mm].
struct DeviationRange {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// Radii that differ by less count as the same reference, as no gauge can distinguish them [mm].
inline constexpr double kSameRadius = 1e-6;
/// Deviations that differ by less are not reported as a range: for most circles, 1 nm of radius
/// changes the deviation by some nm [mm].
inline constexpr double kSameDeviation = 1e-4;

/// Finds the range of deviation of a profile, in the linear model of its rows, over all centres
/// whose circumscribed or inscribed radius equals the optimum to kSameRadius. There are several
/// where two opposite values hold a circle that can still slide across them.
///
/// @param rows     Value and gradient of each angle.
/// @param step     Move to the optimum.
/// @param weights  One of them is 0.
/// @return Nothing where the range is narrower than kSameDeviation. O(n) for each side of the
///         polygon of such centres.
[[nodiscard]] std::optional<DeviationRange> deviation_range(const ZoneRows<2>& rows,
                                                            const Eigen::Vector2d& step,
                                                            const ZoneWeights& weights);

/// Finds the same range for the maximum inscribed circles of points, with centres inside their
/// hull. These circles need not be neighbours: the search divides the plane into squares and keeps
/// those that hold the centre of a circle equal to the largest to kSameRadius. (The minimum
/// circumscribed circle of points is unique.)
///
/// @param center_mm, radius_mm  The largest inscribed circle.
/// @return as deviation_range(); also nothing when the search reached its limit of 20000 squares.
[[nodiscard]] std::optional<DeviationRange> inscribed_deviation_range(
    PlanePoints points_mm, const Eigen::Vector2d& center_mm, double radius_mm);

}  // namespace rondure::fit
