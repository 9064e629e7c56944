#pragma once

#include <span>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/plane.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// The rigid motion, without scale or reflection, that brings points closest to their partners.
struct Registration {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();  ///< Maps `from` to `to`.
  double largest_residual_mm = 0.0;  ///< Greatest distance of a moved point from its partner [mm].
};

/// Minimises the sum of weight_i |motion * from_i - to_i|^2 over rotations and shifts, in closed
/// form by the singular value decomposition of the covariance. Never a reflection.
/// @param from_mm, to_mm  Partners in the same order, n >= 3, not on one line [mm].
/// @param weights  One per pair, > 0; empty: all equal.
/// @return kTooFewPoints (n < 3 or different counts), kNotFinite, kCollinear (the points of `from`
///         lie on one line within 1e-6 of their spread: the turn about it is undetermined).
/// Source: S. Umeyama, "Least-squares estimation of transformation parameters between two point
/// patterns", IEEE Trans. PAMI 13(4), 1991 (the guard against reflections).
[[nodiscard]] core::Result<Registration> rigid_registration(SpacePoints from_mm, SpacePoints to_mm,
                                                            std::span<const double> weights = {});

/// The rigid motion that brings points of one height z closest to their partners on a plane: it
/// carries z to the normal, and their height onto the plane. The turn about the normal and the
/// shift along the plane minimise the sum of squared distances, in closed form.
/// @param from_mm, to_mm  Partners in the same order, n >= 2, not all in one place. Partners off
///                        the plane stand for their feet on it [mm].
/// @return as rigid_registration(); kCollinear where all points of `from` coincide.
/// Source: methods, machine cell section 6.2.
[[nodiscard]] core::Result<Registration> plane_registration(SpacePoints from_mm, SpacePoints to_mm,
                                                            const Plane& plane);

}  // namespace rondure::fit
