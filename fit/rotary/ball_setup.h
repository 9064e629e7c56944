#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "fit/rotary/errors.h"

namespace rondure::fit {

/// Rows of equation dp = t + w x p for n balls: [I3, -[p]x] stacked, 3n x 6.
/// @param p_mm  Balls relative to the origin of the axis.
[[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 6> error_matrix(
    std::span<const Eigen::Vector3d> p_mm);

/// How well balls at these places tell the six errors, all measured alike.
struct BallSetup {
  double condition = 0.0;      ///< Origin at the centroid, lengths in rms distances from it; >= 1.
  double raw_condition = 0.0;  ///< Origin at the axis, rotations over `scale_mm`.
  int rank = 0;                ///< 6 when all errors are determined.
  Vector6 u_per_u = Vector6::Zero();  ///< u(t)/u [-] at the origin; u(w)/u [rad/mm].
  Matrix6 covariance_per_u2 = Matrix6::Zero();
  std::vector<Eigen::Vector3d> redundancy;  ///< Of each coordinate, 0 (unchecked) to 1.
};

/// Judges a setup. Equation (2): cov(w) = u^2 M^-1, cov(t) = u^2 (I/n + [pc]x M^-1 [pc]x^T).
/// @param p_mm      n >= 1 balls relative to the origin of the axis [mm], finite.
/// @param scale_mm  Length for `raw_condition`.
/// @return With rank below 6 the figures are infinite and the redundancy is empty. O(n).
[[nodiscard]] BallSetup judge_setup(std::span<const Eigen::Vector3d> p_mm, double scale_mm = 100.0);

/// A condition above this deserves a warning; above the second, the balls are nearly on a line.
inline constexpr double kConditionWarning = 10.0;
inline constexpr double kConditionLimit = 100.0;

/// Refuses balls that do not determine the six errors, naming the ball that would cure it.
/// @param names  One a ball.
/// @return kTooFewPoints (fewer than 3), kCollinear (second singular value of the centred balls
///         below 1e-3 of the first, or condition above kConditionLimit): `what` says how far from
///         which line a further ball must be for a condition of at most kConditionWarning.
[[nodiscard]] core::Result<void> check_setup(std::span<const Eigen::Vector3d> p_mm,
                                             std::span<const std::string> names);

}  // namespace rondure::fit
