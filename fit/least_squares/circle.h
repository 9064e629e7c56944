#pragma once

#include <span>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::fit {

/// A least-squares circle.
struct LsCircle {
  Eigen::Vector2d center_mm = Eigen::Vector2d::Zero();
  double radius_mm = 0.0;
  double deviation_mm = 0.0;  ///< Radial peak to valley about the centre [mm].
  double rms_mm = 0.0;        ///< Root mean square of the radial residuals [mm].
};

/// Algebraic circle (Kasa): minimises the sum of (|p - c|^2 - R^2)^2 in closed form; exact for
/// points of one circle. The start of every search here.
///
/// @param points_mm  n >= 3, any order [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kCollinear. O(n), no iteration.
/// Source: methods, cylindricity section 5; I. Kasa, IEEE Trans. Instrum. Meas. 25 (1976).
[[nodiscard]] core::Result<LsCircle> algebraic_circle(std::span<const Eigen::Vector2d> points_mm);

/// algebraic_circle() without its residuals: deviation and rms stay 0. Where a search starts they
/// would cost as much as the circle.
[[nodiscard]] core::Result<LsCircle> algebraic_start(std::span<const Eigen::Vector2d> points_mm);

/// Least-squares circle in the sense of ISO 12181 (LSCI): minimises the sum of squared radial
/// distances by damped Gauss-Newton from the algebraic circle; where that does not settle, as on
/// flat arcs, in the coefficients of A (x^2 + y^2) + B x + C y + D = 0.
///
/// @return as algebraic_circle(), and kNotConverged.
/// Source of the second: N. Chernov, C. Lesort, J. Math. Imaging Vis. 23 (2005) 239-252.
[[nodiscard]] core::Result<LsCircle> ls_circle(std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::fit
