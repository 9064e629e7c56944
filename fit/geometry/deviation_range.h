#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "fit/zone/simplex.h"

namespace rondure::fit {

/// Deviations about circles that serve as the same reference equally well.
struct DeviationRange {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// Radii that differ by less are the same reference: no gauge tells them apart.
inline constexpr double kSameRadius = 1e-6;
/// Deviations that differ by less need no word: about most circles 1 nm of radius moves some nm.
inline constexpr double kSameDeviation = 1e-4;

/// The range of a profile, in the linear model of its rows: over all centres whose circumscribed or
/// inscribed radius is as good as the optimum to kSameRadius. Two opposite values can hold a circle
/// that is still free to slide across them.
///
/// @param rows     Value and gradient of each angle.
/// @param step     The optimum.
/// @param weights  One of them is 0.
/// @return Nothing where the range is narrower than kSameDeviation. O(n) for each side of the
///         polygon of such centres.
[[nodiscard]] std::optional<DeviationRange> deviation_range(const ZoneRows<2>& rows,
                                                            const Eigen::Vector2d& step,
                                                            const ZoneWeights& weights);

/// The same of the maximum inscribed circles of points inside their hull, which need not lie side
/// by side: squares of centres are searched that hold a circle as large to kSameRadius. (The
/// minimum circumscribed circle of points is unique.)
///
/// @param center_mm, radius_mm  The largest.
/// @return as above; also nothing when the search reached its limit.
[[nodiscard]] std::optional<DeviationRange> inscribed_deviation_range(
    std::span<const Eigen::Vector2d> points_mm, const Eigen::Vector2d& center_mm, double radius_mm);

}  // namespace rondure::fit
