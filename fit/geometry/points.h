#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::fit {

using PlanePoints = std::span<const Eigen::Vector2d>;
using SpacePoints = std::span<const Eigen::Vector3d>;

/// Checks every fitter makes first: at least one point, every coordinate finite and at most
/// 1e7 mm.
/// @return kNoPoints, or kNotFinite or kOutOfRange naming the row.
[[nodiscard]] core::Result<void> check_points(std::span<const Eigen::Vector2d> points_mm);
[[nodiscard]] core::Result<void> check_points(std::span<const Eigen::Vector3d> points_mm);

/// The mean point; the sums are taken relative to the first point, so that a set far from the
/// origin keeps its digits.
[[nodiscard]] Eigen::Vector2d mean_point(std::span<const Eigen::Vector2d> points_mm);
[[nodiscard]] Eigen::Vector3d mean_point(std::span<const Eigen::Vector3d> points_mm);

/// Number of different points, counted up to `enough` <= 8.
[[nodiscard]] std::size_t distinct_points(std::span<const Eigen::Vector2d> points_mm,
                                          std::size_t enough);
[[nodiscard]] std::size_t distinct_points(std::span<const Eigen::Vector3d> points_mm,
                                          std::size_t enough);

/// The k-th of the rows that stand for `count` rows: multiples of the golden ratio, even over the
/// whole for any number of them, and in step with no layer or turn of a scan.
[[nodiscard]] std::size_t spread_row(std::size_t k, std::size_t count);

/// Fills `out_mm` with the points of the first so many spread_row(), or with all points where it
/// holds as many.
///
/// @param out_mm  At most as many as there are points.
void sample_points(std::span<const Eigen::Vector2d> points_mm, std::span<Eigen::Vector2d> out_mm);
void sample_points(std::span<const Eigen::Vector3d> points_mm, std::span<Eigen::Vector3d> out_mm);

/// Largest angle without a point, seen from a centre [rad]; 2 pi for a single direction.
[[nodiscard]] double largest_gap_rad(std::span<const Eigen::Vector2d> points_mm,
                                     const Eigen::Vector2d& center_mm);

/// Corners of the convex hull, counter-clockwise. O(n log n).
[[nodiscard]] std::vector<Eigen::Vector2d> convex_hull(std::span<const Eigen::Vector2d> points_mm);

/// Whether a square (half side 0: a point) may reach into a hull; false only where a side of the
/// hull separates them.
[[nodiscard]] bool meets_hull(std::span<const Eigen::Vector2d> hull_mm,
                              const Eigen::Vector2d& center_mm, double half_side_mm);

}  // namespace rondure::fit
