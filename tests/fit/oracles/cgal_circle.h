#pragma once

// Circles by CGAL's exact diagrams; the file that includes CGAL is cgal_circle.cpp.

#include <span>
#include <vector>

#include <Eigen/Core>

#include "brute_circle.h"

namespace rondure::test {

/// The narrowest zone of all centres: its centre is a vertex of the overlay of the nearest-point
/// and the farthest-point Voronoi diagram, that is a vertex of one of them or a crossing of an edge
/// of each. (V. B. Le, D. T. Lee, Out-of-roundness problem revisited, IEEE PAMI 13, 1991.)
[[nodiscard]] CirclePlace cgal_min_zone(std::span<const Eigen::Vector2d> points_mm);

/// The least enclosing circle, exact (CGAL::Min_circle_2).
[[nodiscard]] CirclePlace cgal_circumscribed(std::span<const Eigen::Vector2d> points_mm);

/// Local maxima of the empty circle: Delaunay triangles that hold their own circumcentre (several
/// triangles of one circle count as one polygon). Radius at each.
[[nodiscard]] std::vector<CirclePlace> cgal_inscribed(std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::test
