#pragma once

#include <span>

#include <Eigen/Core>

#include "fit/geometry/axis.h"

namespace rondure::benchmarks {

/// A least-squares cylinder as a user of Ceres writes it.
struct CeresCylinder {
  fit::Axis axis;
  double radius_mm = 0.0;
  double rms_mm = 0.0;
};

/// Least squares of the radial distances with automatic derivatives, one residual a point, one
/// thread. Five unknowns: two shifts, two slopes about the start axis, the radius.
[[nodiscard]] CeresCylinder ceres_ls_cylinder(std::span<const Eigen::Vector3d> points_mm,
                                              const Eigen::Vector3d& start_direction);

}  // namespace rondure::benchmarks
