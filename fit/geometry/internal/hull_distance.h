#pragma once

#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// The closest points of two convex hulls in the plane.
struct HullDistance {
  double distance = 0.0;  ///< 0 when they meet.
  Eigen::Vector2d on_first = Eigen::Vector2d::Zero();
  Eigen::Vector2d on_second = Eigen::Vector2d::Zero();
  bool vertices = false;  ///< The closest points are a vertex of each, not inside an edge.
};

/// Distance between the convex hulls of two sets of unit vectors (the contacts of a centre). Exact:
/// points of one circle are in convex position, so that the edges are the chords between neighbours
/// by angle, and hulls meet only where chords cross or vertices coincide.
///
/// @param first, second  Not empty; unit vectors, any order, duplicates allowed.
[[nodiscard]] HullDistance hull_distance(std::vector<Eigen::Vector2d> first,
                                         std::vector<Eigen::Vector2d> second);

/// Twice the signed area of the triangle a, b, c; > 0 if c lies to the left of a -> b.
[[nodiscard]] inline double twice_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                       const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Whether the segments ab and cd cross in a point inside both.
[[nodiscard]] bool segments_cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                  const Eigen::Vector2d& c, const Eigen::Vector2d& d);

}  // namespace rondure::fit
