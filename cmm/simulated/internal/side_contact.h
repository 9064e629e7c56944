#pragma once

#include <optional>

#include <Eigen/Core>

#include "cmm/simulated/part.h"
#include "core/result.h"

namespace rondure::cmm {

/// A sphere that moves along a straight line, part frame.
struct SphereSweep {
  Eigen::Vector3d start_P_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction_P = Eigen::Vector3d::UnitX();  ///< Unit vector.
  double radius_mm = 0.0;                                  ///< > 0.
  double travel_mm = 0.0;                                  ///< Largest travel.
};

/// First contact of a sweep with the round side of a part, or its rims.
struct SideContact {
  double travel_mm = 0.0;  ///< < 0: overlap of the sphere with the side at its start.
  Eigen::Vector3d point_P_mm = Eigen::Vector3d::Zero();
};

/// The least travel at which the sphere touches any point X of the side, rims included.
///
/// The sphere reaches a single point X after the travel
///   s(X) = d.w - sqrt(rho^2 - |w - (d.w) d|^2),   w = X - start,
/// and the contact is the minimum of s over the surface: no radial shortcut, no assumption about
/// which point is met. A box of the surface whose points lie within delta of its centre cannot be
/// met before a sphere of radius rho + delta meets that centre; branch and bound with this bound
/// finds every candidate, Newton's method with analytic derivatives finishes it.
///
/// Where the form is gentle (curvature * rho < 0.5, the offset surface has no folds), the sphere
/// starts on the free side of the surface and meets it steeper than 30 deg, the minimum next to the
/// contact with the ideal cylinder is the only one, and Newton starts there.
///
/// @return Nothing when the side is out of range; kNotConverged when Newton's method fails.
[[nodiscard]] core::Result<std::optional<SideContact>> first_side_contact(
    const PartSurface& surface, const SphereSweep& sweep);

}  // namespace rondure::cmm
