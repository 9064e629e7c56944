#pragma once

#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/cylinder_frame.h"
#include "fit/local_certificate.h"

namespace rondure::fit {

/// Least and largest distance of the points from an axis [mm].
struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;
  [[nodiscard]] double width() const { return high - low; }
};
[[nodiscard]] Extremes extremes(std::span<const Eigen::Vector3d> points,
                                const CylinderFrame& frame);

/// State of the descent: the axis, its zone, and the contacts of the last programme.
struct CylinderDescent {
  CylinderFrame frame;
  Extremes zone;
  std::vector<Contact> outer;
  std::vector<Contact> inner;
  int programmes = 0;  ///< Linear programmes solved so far.
};

/// Goes from an axis to a local minimum of the zone: linear programmes inside a trust region,
/// Newton on the stationarity equations of the contacts, and a way out of saddles. Of large sets a
/// part is looked at, to which all points outside its zone are added until there are none.
///
/// @param points     Relative to their mean.
/// @param round_off  Size of rounding errors of a distance [mm].
/// Source: methods, cylindricity section 11.2.
void descend(std::span<const Eigen::Vector3d> points, CylinderDescent& state, double round_off);

/// What the points within round-off of the zone prove about it.
[[nodiscard]] LocalProof<4> prove_cylinder(std::span<const Eigen::Vector3d> points,
                                           const CylinderFrame& frame, const Extremes& zone,
                                           double round_off);

}  // namespace rondure::fit
