#pragma once

#include <Eigen/Core>

#include "cmm/simulated/part_surface.h"

namespace rondure::cmm {

/// True when a sphere is certain to stay clear of the solid on the straight line from a to b (part
/// frame); false when a closer check is needed. Costs a few dozen operations.
/// @param deviation_mm  Bound of the form toward the free side (shape_bounds()).
[[nodiscard]] bool surely_clear(const PartSurface& surface, double deviation_mm,
                                const Eigen::Vector3d& a_P_mm, const Eigen::Vector3d& b_P_mm,
                                double sphere_radius_mm);

}  // namespace rondure::cmm
