#pragma once

#include <span>

#include <Eigen/Core>

namespace rondure::benchmarks {

/// Width of the minimum-zone circle by ALGLIB's fitspheremz() [mm].
[[nodiscard]] double alglib_zone_width_mm(std::span<const Eigen::Vector2d> points_mm);

}  // namespace rondure::benchmarks
