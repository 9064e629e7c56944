#pragma once

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/points.h"

namespace rondure::fit {

/// Effective tip radius of a probe, from touches of a reference sphere.
struct ProbeTip {
  Eigen::Vector3d sphere_center_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;  ///< rho: effective (pre-travel included), usually below the nominal one.
  double radius_sigma_mm = 0.0;   ///< Standard deviation of rho from the residuals.
  double radius_per_touch = 0.0;  ///< The same for touches with standard deviation 1.
  double form_mm = 0.0;           ///< Probing form: peak to valley of the residuals.
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

}  // namespace rondure::fit
