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

/// How well balls at given positions determine the six errors, if all are measured equally well.
struct BallSetup {
  double condition = 0.0;      ///< Origin at the centroid, unit the rms distance from it; >= 1.
  double raw_condition = 0.0;  ///< Origin at the axis, rotations scaled by `scale_mm`.
  int rank = 0;                ///< 6 when all errors are determined.
  Vector6 u_per_u = Vector6::Zero();  ///< u(t)/u [-] at the origin; u(w)/u [rad/mm].
  Matrix6 covariance_per_u2 = Matrix6::Zero();
  std::vector<Eigen::Vector3d> redundancy;  ///< Per coordinate, 0 (unchecked) to 1.
};

/// Evaluates a setup. Equation (2): cov(w) = u^2 M^-1, cov(t) = u^2 (I/n + [pc]x M^-1 [pc]x^T).
/// @param p_mm      n >= 1 balls relative to the origin of the axis [mm], finite.
/// @param scale_mm  Length by which `raw_condition` scales rotations.
/// @return If the rank is below 6, the figures are infinite and the redundancy is empty. O(n).
[[nodiscard]] BallSetup judge_setup(std::span<const Eigen::Vector3d> p_mm, double scale_mm = 100.0);

/// A condition above kConditionWarning causes a warning; above kConditionLimit the balls are nearly
/// on a line.
inline constexpr double kConditionWarning = 10.0;
inline constexpr double kConditionLimit = 100.0;

/// Refuses balls that do not determine the six errors, and names the further ball that is needed.
/// @param names  One per ball.
/// @return kTooFewPoints (fewer than 3), kCollinear (second singular value of the centred balls
///         below 1e-3 of the first, or condition above kConditionLimit): `what` states the distance
///         of a further ball from the named line for a condition of at most kConditionWarning.
[[nodiscard]] core::Result<void> check_setup(std::span<const Eigen::Vector3d> p_mm,
                                             std::span<const std::string> names);

}  // namespace rondure::fit
