#pragma once

// Reference circles by enumeration of all contact sets, in long double. Slow and simple.

#include <span>
#include <vector>

#include <Eigen/Core>

namespace rondure::test {

using Real = long double;
using Vector2r = Eigen::Matrix<Real, 2, 1>;

/// A centre and its value.
struct CirclePlace {
  Vector2r center_mm = Vector2r::Zero();
  Real value_mm = 0.0L;  ///< Zone width, or radius.
};

/// Distance of the nearest and of the farthest point from a centre.
struct Reach {
  Real low_mm = 0.0L;
  Real high_mm = 0.0L;
};
[[nodiscard]] Reach reach_from(std::span<const Eigen::Vector2d> points_mm,
                               const Vector2r& center_mm);

/// The narrowest zone of all centres of the plane: every minimum has two outer and two inner
/// contacts (or more), so it is a crossing of two bisectors; three outer and one inner contacts
/// cross as well. O(n^5).
[[nodiscard]] CirclePlace brute_min_zone(std::span<const Eigen::Vector2d> points_mm);

/// Width of the narrowest strip that holds the points: the zone of a centre at infinity. Where it
/// is below brute_min_zone(), the plane has no narrowest zone. O(n^3).
[[nodiscard]] Real brute_strip(std::span<const Eigen::Vector2d> points_mm);

/// The least circle around all points: through two (a diameter) or three of them. O(n^4).
[[nodiscard]] CirclePlace brute_circumscribed(std::span<const Eigen::Vector2d> points_mm);

/// All local maxima of the empty circle: through three points, none inside, and the contacts leave
/// no gap of 180 deg, so that the centre lies inside their hull. Equal centres once. O(n^4).
[[nodiscard]] std::vector<CirclePlace> brute_inscribed(std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::test
