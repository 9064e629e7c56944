#pragma once

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// A least-squares circle (D = 2) or sphere (D = 3).
template <int D>
struct LsCenter {
  Eigen::Matrix<double, D, 1> center_mm = Eigen::Matrix<double, D, 1>::Zero();
  double radius_mm = 0.0;
  double deviation_mm = 0.0;  ///< Radial peak to valley about the centre [mm].
  double rms_mm = 0.0;        ///< Root mean square of the radial residuals [mm].
};
using LsCircle = LsCenter<2>;
using LsSphere = LsCenter<3>;

/// Fits the algebraic circle (Kasa): minimises the sum of (|p - c|^2 - R^2)^2 in closed form. Exact
/// for points of one circle. All circle searches start from it.
///
/// @param points_mm  n >= 3, any order [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear. O(n), no iteration.
/// Source: methods, cylindricity section 5; I. Kasa, IEEE Trans. Instrum. Meas. 25 (1976).
[[nodiscard]] core::Result<LsCircle> algebraic_circle(PlanePoints points_mm);

/// Like algebraic_circle(), but leaves deviation and rms at 0. At the start of a search, computing
/// them would cost as much as the circle.
[[nodiscard]] core::Result<LsCircle> algebraic_start(PlanePoints points_mm);

/// Fits the least-squares circle of ISO 12181 (LSCI): minimises the sum of squared radial distances
/// by damped Gauss-Newton from the algebraic circle. Where that does not converge, as on flat arcs,
/// it minimises over the coefficients of A (x^2 + y^2) + B x + C y + D = 0 instead.
///
/// @param points_mm  n >= 3, any order [mm].
/// @return as algebraic_circle(); also kNotConverged.
/// Source of the second method: N. Chernov, C. Lesort, J. Math. Imaging Vis. 23 (2005) 239-252.
[[nodiscard]] core::Result<LsCircle> ls_circle(PlanePoints points_mm);

}  // namespace rondure::fit
