#pragma once

#include <span>

#include <Eigen/Core>

#include "fit/axis.h"

namespace rondure::benchmarks {

/// Least and largest squared distance [mm^2].
struct Extremes {
  double low = 0.0;
  double high = 0.0;

  /// Radial gap [mm].
  [[nodiscard]] double width_mm() const;
};

/// S1: one pass over all points, SIMD, one thread. The unit every time is compared with.
[[nodiscard]] Extremes streaming_pass(std::span<const Eigen::Vector3d> points_mm,
                                      const fit::Axis& axis);
[[nodiscard]] Extremes streaming_pass(std::span<const Eigen::Vector2d> points_mm,
                                      const Eigen::Vector2d& center_mm);

/// The least that can be done with the points: reads each number once and adds it.
[[nodiscard]] double read_and_sum(std::span<const double> numbers);

}  // namespace rondure::benchmarks
