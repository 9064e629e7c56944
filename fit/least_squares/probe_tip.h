#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// Effective tip radius of a probe, from touches of a reference sphere or a reference column.
struct ProbeTip {
  /// Centre of the sphere; of a column the point of its axis at the mean height of the touches.
  Eigen::Vector3d sphere_center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;  ///< rho: effective (pre-travel included), usually below the nominal one.
  double radius_sigma_mm = 0.0;   ///< Standard deviation of rho from the residuals.
  double radius_per_touch = 0.0;  ///< The same for touches with standard deviation 1.
  double form_mm = 0.0;           ///< Probing form: peak to valley of the residuals.
  Eigen::Vector3d column_axis = Eigen::Vector3d::Zero();  ///< Unit vector; zero for a sphere.

  [[nodiscard]] bool on_column() const { return column_axis.squaredNorm() > 0.0; }
  /// Angle of the axis of a column to z; 0 for a sphere.
  [[nodiscard]] double lean_rad() const {
    return std::atan2(column_axis.head<2>().norm(), std::abs(column_axis.z()));
  }
};

/// Determines the effective tip radius: fits a least-squares sphere to the tip centres and
/// subtracts the certified radius of the reference sphere from that of the fit.
///
/// @param tip_centers_mm  n >= 5, not all on one circle [mm].
/// @param sphere_radius_mm  Certified radius of the reference sphere [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kRank (all on one circle),
///         kNotConverged.
/// Source: methods, cylindricity section 2.1.
[[nodiscard]] core::Result<ProbeTip> qualify_tip(SpacePoints tip_centers_mm,
                                                 double sphere_radius_mm);

/// The same from touches across the axis of a column, a cylinder that may lean: the centres of a
/// ball that touches a cylinder lie on a cylinder. The circle of one height alone would be too
/// large by R eps^2 / 4 for a lean eps.
///
/// @param tip_centers_mm    n >= 6, at two heights or more [mm].
/// @param column_radius_mm  Certified radius of the column [mm].
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kRank (one height), kNotConverged.
/// Source: methods, machine cell section 6.1.
[[nodiscard]] core::Result<ProbeTip> qualify_tip_on_column(SpacePoints tip_centers_mm,
                                                           double column_radius_mm);

/// The weights with which errors of the touches, each along its normal, enter the radius of the
/// fitted sphere or column.
[[nodiscard]] Eigen::VectorXd radius_weights(SpacePoints tip_centers_mm, const ProbeTip& tip);

}  // namespace rondure::fit
