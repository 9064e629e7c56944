#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/certificate.h"

namespace rondure::fit {

/// One point of a zone, linearised: its distance and the gradient of that distance with respect to
/// the K unknowns of the axis (2 for a circle, 4 for a cylinder), all in mm.
template <int K>
struct ZoneRow {
  double distance = 0.0;
  Eigen::Matrix<double, K, 1> gradient = Eigen::Matrix<double, K, 1>::Zero();
};

/// Solution of the linearised zone.
template <int K>
struct ZoneStep {
  Eigen::Matrix<double, K, 1> step = Eigen::Matrix<double, K, 1>::Zero();  ///< The move d [mm].
  double width = 0.0;          ///< Zone the linearisation predicts after the move [mm].
  std::vector<Contact> outer;  ///< Points that bind, with their multipliers (> 0).
  std::vector<Contact> inner;
  bool inside_box = false;  ///< No side of the box binds.
  bool solved = false;      ///< false: the pivot limit ended it.
  int pivots = 0;
};

/// Minimises  max_i (r_i + J_i d) - min_i (r_i + J_i d)  over moves d with |d_k| <= box_mm.
///
/// Primal simplex on the dual programme (K + 2 rows; a column for each point on each side and for
/// each side of the box). The box makes a first basis feasible at once, so there is no first phase.
/// Dantzig's rule, Bland's after 300 pivots. The basis is factorised anew at every pivot: it is at
/// most 6 x 6, and no error accumulates.
///
/// @param rows  At least one point. Distances may be given minus a common value.
/// Cost: O(n K) a pivot, commonly 5 to 20 pivots.
/// Source: methods, cylindricity sections 9.3 and 11.2 (the box is its trust region).
template <int K>
[[nodiscard]] ZoneStep<K> solve_zone_program(std::span<const ZoneRow<K>> rows, double box_mm);

}  // namespace rondure::fit
