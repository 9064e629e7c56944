#pragma once

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// The centre of a ball of known radius.
struct BallCenter {
  Eigen::Vector3d center_mm = Eigen::Vector3d::Zero();
  /// Covariance of the centre for touches with standard deviation 1 along their direction; multiply
  /// by the variance of a touch.
  Eigen::Matrix3d cofactor = Eigen::Matrix3d::Zero();
  /// Its change per change of the radius that is held.
  Eigen::Vector3d per_radius = Eigen::Vector3d::Zero();
  double sum_mm = 0.0;           ///< Sum of the radial residuals.
  double sum_per_radius = 0.0;   ///< Its change likewise; <= 0.
  double sum_squares_mm2 = 0.0;  ///< Sum of squares of the radial residuals.
  double deviation_mm = 0.0;     ///< Radial peak to valley about the centre [mm].
};

/// Fits the least-squares sphere of given radius: minimises sum (|p - c| - r)^2 by Gauss-Newton
/// from the sphere of free radius. A fixed radius halves the uncertainty along the axis of a half
/// sphere of touches: 25 points give 0.34, 0.35, 0.35 s instead of 0.34, 0.35, 0.69 s.
///
/// @param points_mm  n >= 4, not in one plane [mm].
/// @param radius_mm  Radius of the sphere on which the points lie, > 0 [mm].
/// @return kBadOption, kNotConverged, and the errors of ls_sphere(). O(n) per step.
/// Source: methods, rotary axes section 3.
[[nodiscard]] core::Result<BallCenter> ball_center(SpacePoints points_mm, double radius_mm);

}  // namespace rondure::fit
