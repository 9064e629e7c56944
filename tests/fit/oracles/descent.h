#pragma once

// An independent minimiser of zones and one-sided radii, for circles and cylinders: sequential
// linear programming in long double inside a trust region, with the simplex of simplex.h.

#include <span>

#include <Eigen/Core>

namespace rondure::test {

using Real = long double;
using Vector2r = Eigen::Matrix<Real, 2, 1>;
using Vector3r = Eigen::Matrix<Real, 3, 1>;

/// Quantity that is minimised.
enum class Reference {
  kMinZone,        ///< largest minus smallest distance
  kCircumscribed,  ///< the largest distance
  kInscribed,      ///< minus the smallest distance
};

/// Smallest and largest distance of the points from a centre or an axis.
struct Extremes {
  Real low_mm = 0.0L;
  Real high_mm = 0.0L;

  [[nodiscard]] Real value_mm(Reference reference) const {
    if (reference == Reference::kMinZone) return high_mm - low_mm;
    return reference == Reference::kCircumscribed ? high_mm : -low_mm;
  }
};

struct CircleOptimum {
  Vector2r center_mm = Vector2r::Zero();
  Extremes at;
};

struct AxisOptimum {
  Vector3r point_mm = Vector3r::Zero();
  Vector3r direction = Vector3r::UnitZ();
  Extremes at;
};

[[nodiscard]] Extremes extremes(std::span<const Eigen::Vector2d> points_mm,
                                const Vector2r& center_mm);
[[nodiscard]] Extremes extremes(std::span<const Eigen::Vector3d> points_mm,
                                const Vector3r& point_mm, const Vector3r& direction);

/// Descends from a start to a local optimum. No step is longer than the trust region, which starts
/// at `reach_mm` and shrinks where the linearisation does not hold. The search ends when the
/// predicted gain is below 1e-19 of the radius, or after 600 linear programs. Tilts of a cylinder
/// count in mm at its ends.
[[nodiscard]] CircleOptimum descend(std::span<const Eigen::Vector2d> points_mm,
                                    const Vector2r& center_mm, Reference reference, Real reach_mm);
[[nodiscard]] AxisOptimum descend(std::span<const Eigen::Vector3d> points_mm,
                                  const Vector3r& point_mm, const Vector3r& direction,
                                  Reference reference, Real reach_mm);

}  // namespace rondure::test
