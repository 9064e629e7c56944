#pragma once

#include <span>

#include <Eigen/Core>

#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fit/geometry/plane.h"

namespace rondure::fit {

/// Parameters of a set of local deviations from a reference (ISO 12180-1, 12181-1, 12780-1, where
/// RON, CYL or STR precedes the letter; FLT for a plane, ISO 12781-1). Peak, valley and rms are
/// defined about the least-squares reference.
struct FormParameters {
  double total_mm = 0.0;   ///< t: peak to valley.
  double peak_mm = 0.0;    ///< p: greatest deviation out of the material, >= 0.
  double valley_mm = 0.0;  ///< v: greatest deviation into the material, as a positive number.
  double rms_mm = 0.0;     ///< q: root mean square.
};

/// Computes the parameters of a set of deviations.
/// @param deviations_mm  Not empty; positive out of the material [mm].
/// @param cells          Length or angle that each deviation represents in the mean square; empty:
///                       all equal; else as many as deviations.
[[nodiscard]] FormParameters form_parameters(std::span<const double> deviations_mm,
                                             std::span<const double> cells = {});

/// Computes CYLt, CYLp, CYLv, CYLq about a cylinder. All four are defined about the least-squares
/// cylinder; about the minimum-zone cylinder (with its mean radius) only CYLt is (ISO 12180-1).
/// @param inside  True for a bore: the material is outside, so peaks point to the axis.
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<FormParameters> cylindricity_parameters(
    std::span<const Eigen::Vector3d> points_mm, const Axis& axis, double radius_mm,
    bool inside = false);

/// Computes FLTt, FLTp, FLTv, FLTq about a plane whose normal points out of the material; all four
/// are defined about the least-squares plane (ISO 12781-1).
/// @return kNoPoints, kNotFinite (row).
[[nodiscard]] core::Result<FormParameters> flatness_parameters(
    std::span<const Eigen::Vector3d> points_mm, const Plane& plane);

}  // namespace rondure::fit
