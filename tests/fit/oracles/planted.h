#pragma once

// Point sets with a known optimum.
//
// A centre or axis is a strict local optimum of a minimum zone (circumscribed, inscribed) when
// multipliers > 0 of its contacts balance their gradients, sum lam J_h = sum mu J_l, and the
// contacts are as many as there are unknowns (methods, certificates section 1). The sets are
// therefore made in this order: draw the contacts, solve for the multipliers, keep the draw when
// all are positive, and place every other point strictly inside.
//
// With slacks a_h = H - J_h x >= 0, b_l = J_l x - G >= 0 the map (x, H, G) -> (a, b) is square and
// sum lam a + sum mu b = H - G: the growth sigma per unit move follows exactly from its inverse. No
// other optimum lies within sigma/K of it (K bounds the curvature), so the form is drawn small
// relative to that ball, and every sensible start lies inside it.
//
// For cylinders with one contact less, angles and multipliers that balance the normals are drawn
// first, then heights in the kernel of the balance of the tilts; the draw is kept when the
// curvature of the Lagrangian is positive along the one direction that the contacts leave free.

#include <algorithm>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "circle_sets.h"
#include "descent.h"

namespace rondure::test {

/// Settings of a planted set. Lengths in mm.
struct Plot {
  Reference reference = Reference::kMinZone;
  double radius_mm = 25.0;
  double half_length_mm = 35.0;  ///< Cylinders only.
  double form_mm = 0.02;         ///< Upper limit of the form; a small ball of uniqueness lowers it.
  double offset_mm = 0.0;        ///< Shift of the set in a random direction.
  int fill = 20;                 ///< Points that are no contacts.
  bool curved = false;           ///< Cylinders only: one contact less, held by curvature.
};

/// The known optimum of a planted set.
struct Optimum {
  double inner_mm = 0.0;   ///< Radius of the inner contacts; 0 without any.
  double outer_mm = 0.0;   ///< Radius of the outer contacts; 0 without any.
  double form_mm = 0.0;    ///< All points lie within this of the contacts' radius.
  double growth = 0.0;     ///< sigma, per mm in the max norm; across the free direction if curved.
  double curvature = 0.0;  ///< Along the free direction [1/mm]; 0 if not curved.
  std::vector<std::size_t> contacts;
};

struct PlantedCircle {
  Points2 points;
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  Optimum optimum;
};

struct PlantedCylinder {
  Points3 points;
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();  ///< A point of the axis.
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  double half_length_mm = 0.0;
  Optimum optimum;
};

/// Same seed, same points. The sets cover full turns, so that the known optimum is the one nearest
/// to the part.
[[nodiscard]] PlantedCircle plant_circle(const Plot& plot, std::uint64_t seed);
[[nodiscard]] PlantedCylinder plant_cylinder(const Plot& plot, std::uint64_t seed);

/// A draw of sizes for the seed-th set of a loop: radius 1 to 200 mm, discs to bars, form 1e-6 to
/// 1e-3 of the radius, offset up to 500 mm.
[[nodiscard]] Plot draw_plot(Reference reference, std::uint64_t seed);

/// Number of sets that a test of a fit draws, and tolerances of the fit against the known optimum
/// [mm, rad].
inline constexpr int kPlanted = 1000;
inline constexpr double kPlace = 1e-9;
inline constexpr double kDirection = 1e-8;

inline std::vector<std::size_t> sorted(std::vector<std::size_t> rows) {
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace rondure::test
