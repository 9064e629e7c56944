#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/rotary/axes.h"
#include "fit/rotary/internal/published_axes.h"

// Solves one station of a rotary axis: from balls to six errors. Used by identify_rotary_axis().

namespace rondure::fit {

/// A ball at one station, relative to the origin of the axis.
struct StationBall {
  std::string ball;
  Eigen::Vector3d nominal_mm = Eigen::Vector3d::Zero();  ///< R(angle) p0.
  Eigen::Vector3d measured_mm = Eigen::Vector3d::Zero();
  Eigen::Matrix3d measured_mm2 =
      Eigen::Matrix3d::Identity();                        ///< Covariance of the measured position.
  Eigen::Matrix3d nominal_mm2 = Eigen::Matrix3d::Zero();  ///< Covariance of the rotated reference.
};

/// Solves a station. Leaves out balls as long as the global test fails and a better set remains.
/// @param printed  For Solver::kAsPublished: its matrix, for exactly the three balls given.
/// @return Always a station; `undetermined` is set if the balls do not determine six errors.
[[nodiscard]] RotaryStation solve_station(std::vector<StationBall> balls,
                                          const RotaryOptions& options,
                                          const std::optional<PublishedMatrix>& printed = {});

}  // namespace rondure::fit
