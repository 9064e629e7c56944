#pragma once

#include <span>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"

namespace rondure::fit {

/// Parameters of a set of local deviations from a reference (ISO 12180-1, 12181-1, 12780-1; RON,
/// CYL or STR stand before the letter). Peak, valley and rms are defined about the least-squares
/// reference.
struct FormParameters {
  double total_mm = 0.0;   ///< t: peak to valley.
  double peak_mm = 0.0;    ///< p: greatest deviation out of the material, >= 0.
  double valley_mm = 0.0;  ///< v: greatest deviation into the material, as a positive number.
  double rms_mm = 0.0;     ///< q: root mean square.
};

/// @param deviations_mm  Not empty; positive out of the material [mm].
/// @param cells          Length or angle each stands for, in the mean square; empty: all alike.
[[nodiscard]] FormParameters form_parameters(std::span<const double> deviations_mm,
                                             std::span<const double> cells = {});

/// CYLt, CYLp, CYLv, CYLq about a cylinder: the least-squares one for all four; of the minimum-zone
/// cylinder (its mean radius) only CYLt is defined (ISO 12180-1).
/// @param inside  A bore: the material is outside, so peaks point to the axis.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<FormParameters> cylindricity_parameters(
    std::span<const Eigen::Vector3d> points_mm, const Axis& axis, double radius_mm,
    bool inside = false);

}  // namespace rondure::fit
