#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::fit {

using PlanePoints = std::span<const Eigen::Vector2d>;
using SpacePoints = std::span<const Eigen::Vector3d>;

/// Checks common to all fitters: at least one point, every coordinate finite and at most 1e7 mm.
/// @return kNoPoints, kNotFinite (row), kOutOfRange (row).
[[nodiscard]] core::Result<void> check_points(PlanePoints points_mm);
[[nodiscard]] core::Result<void> check_points(SpacePoints points_mm);

/// Mean of the points. The sums are taken relative to the first point, so that a set far from the
/// origin keeps its digits.
/// @pre At least one point.
[[nodiscard]] Eigen::Vector2d mean_point(PlanePoints points_mm);
[[nodiscard]] Eigen::Vector3d mean_point(SpacePoints points_mm);

/// Number of different points, counted up to `enough` <= 8.
[[nodiscard]] std::size_t distinct_points(PlanePoints points_mm, std::size_t enough);
[[nodiscard]] std::size_t distinct_points(SpacePoints points_mm, std::size_t enough);

/// Returns the k-th row of a sample of `count` rows. The rows follow multiples of the golden ratio,
/// so that any number of them is spread evenly and does not coincide with layers or turns of a
/// scan.
[[nodiscard]] std::size_t spread_row(std::size_t k, std::size_t count);

/// Fills `out_mm` with a sample: the points of spread_row() 0, 1, 2, ..., or all points in order if
/// `out_mm` has room for all.
///
/// @pre `out_mm` is not longer than `points_mm`.
void sample_points(PlanePoints points_mm, std::span<Eigen::Vector2d> out_mm);
void sample_points(SpacePoints points_mm, std::span<Eigen::Vector3d> out_mm);

/// Largest angle without a point as seen from the centre [rad]; 2 pi for a single direction.
[[nodiscard]] double largest_gap_rad(PlanePoints points_mm, const Eigen::Vector2d& center_mm);

/// Corners of the convex hull, counter-clockwise. O(n log n).
[[nodiscard]] std::vector<Eigen::Vector2d> convex_hull(PlanePoints points_mm);

/// Least distance of two parallel lines that hold the points between them, over all directions; 0
/// for points on one line. Exact: one of the lines passes through a side of the hull. O(n log n).
/// Source: M. E. Houle, G. T. Toussaint, IEEE Trans. PAMI 10 (1988) 761-765.
[[nodiscard]] double least_width(PlanePoints points_mm);

/// Whether a square (half side 0: a point) may overlap a hull; false only if a side of the hull
/// separates them.
[[nodiscard]] bool meets_hull(PlanePoints hull_mm, const Eigen::Vector2d& center_mm,
                              double half_side_mm);

}  // namespace rondure::fit
