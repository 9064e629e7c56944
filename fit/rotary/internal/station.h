#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fit/rotary/axes.h"
#include "fit/rotary/errors.h"

namespace rondure::fit {

// The matrices of CN105479268A for the swivel axes C (about Z) and A (about X) of a five-axis head.
// For comparison only: identify_rotary_axis() accepts any arrangement of balls.

/// Two vertical (L) and two horizontal (H) distances of the ball from the intersection of the axes.
/// The head hangs, so that a ball is at (0, H, -L).
struct PublishedSetups {
  double l1_mm = 0.0;
  double l2_mm = 0.0;
  double h1_mm = 0.0;
  double h2_mm = 0.0;

  /// The three setups of the C matrix: (L1, H1), (L1, H2), (L2, H1).
  [[nodiscard]] std::array<Eigen::Vector3d, 3> of_c() const;
  /// The three setups of the A matrix: (L1, H1), (L1, H2), (L2, H2).
  [[nodiscard]] std::array<Eigen::Vector3d, 3> of_a() const;
};

using PublishedMatrix = Eigen::Matrix<double, 9, 6>;

/// Rows X, Y, Z of the three setups; columns X, Y, Z, al, be, ga.
[[nodiscard]] PublishedMatrix published_c_matrix(const PublishedSetups& setups, double c_rad);
/// Row Y, column al is printed without its operator, "-H sin A  L cos A"; it is -H sin A + L cos A.
[[nodiscard]] PublishedMatrix published_a_matrix(const PublishedSetups& setups, double a_rad);

// Solves one station of a rotary axis: from balls to six errors. Used by identify_rotary_axis().

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
