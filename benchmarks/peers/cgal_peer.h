#pragma once

#include <cstddef>
#include <span>

#include <Eigen/Core>

namespace rondure::benchmarks {

/// Width of CGAL's annulus of least area (Min_annulus_d): not a minimum zone, the nearest thing
/// CGAL has to it [mm].
[[nodiscard]] double cgal_annulus_width_mm(std::span<const Eigen::Vector2d> points_mm);

/// Radius of the smallest circle that holds all points (Min_sphere_of_spheres_d) [mm].
[[nodiscard]] double cgal_smallest_circle_mm(std::span<const Eigen::Vector2d> points_mm);

/// Number of triangles of the Delaunay triangulation, the first step of every Voronoi method.
[[nodiscard]] std::size_t cgal_delaunay_triangles(std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::benchmarks
