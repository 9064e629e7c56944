#pragma once

#include <span>
#include <string>

#include <Eigen/Core>

#include "fit/wheel/path.h"
#include "fit/wheel/wheel.h"

namespace rondure::reports {

/// The edge of a wheel: deviations of its points about the mean circle, magnified; in its middle,
/// at the same magnification, the centres of the quadruples and the spindle axis.
[[nodiscard]] std::string wheel_edge_plot(const fit::WheelMeasurement& wheel,
                                          std::span<const Eigen::Vector2d> points_mm);

/// Side view of a path, x and z at one scale: the surface, the path of the wheel's centre, the
/// wheel at both ends and halfway.
[[nodiscard]] std::string wheel_path_plot(const fit::WheelPath& path);

}  // namespace rondure::reports
