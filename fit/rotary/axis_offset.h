#pragma once

#include "core/result.h"
#include "fit/rotary/model.h"

namespace rondure::fit {

/// Location and orientation of the true axis: the errors that do not depend on the angle.
/// Components along the axis cannot be determined and are zero.
struct AxisOffset {
  Eigen::Vector3d d_mm = Eigen::Vector3d::Zero();    ///< Displacement of the axis [mm].
  Eigen::Vector3d d_u_mm = Eigen::Vector3d::Zero();  ///< Standard uncertainty of x, y, z.
  Eigen::Vector3d e_rad = Eigen::Vector3d::Zero();   ///< Tilt of the axis [rad].
  Eigen::Vector3d e_u_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d c_mm = Eigen::Vector3d::Zero();   ///< Constant of the translations, not an error
  Eigen::Vector3d c_rad = Eigen::Vector3d::Zero();  ///< of the axis: mean PDGE, reference noise.
  double zero_point_rad = 0.0;  ///< Mean of w along the axis: offset of the angle's zero.
  double arc_rad = 0.0;         ///< Angle that the stations span.
  double arc_factor = 1.0;      ///< u(d) relative to that of a full circle: 1 / sqrt(1 - |mean|^2).
  RotaryAxis axis;              ///< The true line: origin + d, direction a + e x a.
};

/// Separates location and orientation of the axis from its motion errors. Fits
/// tau(phi) = c + (1 - e^{j phi}) d in the plane across the axis by complex least squares, once for
/// t and once for w. Exact on a full circle, where the forward first harmonic is the offset by
/// definition; on a short arc the offset takes up slow motion errors as well.
/// @return kTooFewPoints (fewer than 3 rows), kShortArc (stations span less than 45 deg: the sum of
///         offset and motion is known, its parts are not).
[[nodiscard]] core::Result<AxisOffset> axis_offset(const RotaryTable& table);

}  // namespace rondure::fit
