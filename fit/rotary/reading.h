#pragma once

#include <span>

#include <Eigen/Core>

#include "fit/rotary/errors.h"

// What the readings of a two-axis fixture add to its errors, and the limits within which a station
// of one axis may be measured while the other does not stand at its zero.

namespace rondure::fit {

/// Covariance that an uncertain turn about a line adds to the six errors: u^2 v v^T with
/// v = (-direction x through, direction).
/// @param direction   Unit vector of the line.
/// @param through_mm  A point of it, from the origin of the translations.
[[nodiscard]] Matrix6 turn_covariance(const Eigen::Vector3d& direction,
                                      const Eigen::Vector3d& through_mm, double u_rad);

/// Covariance of the six errors of a station by balls that were set up one by one: at each the axis
/// repeats anew, and each stands off by what its tool was set wrong in y and z, which the control
/// takes for an error of the axis.
/// @param p_mm  At least 3 balls in the reference pose, from the origin of the axis.
/// Source: methods, analyses_uncertainty 3.1.
[[nodiscard]] Matrix6 setup_covariance(std::span<const Eigen::Vector3d> p_mm,
                                       const RotaryAxis& axis, double turned_rad, double repeat_rad,
                                       double tool_mm);

/// The covariance of (t; w) after a turn of the frame, the origin unchanged.
[[nodiscard]] Matrix6 turned_covariance(const Matrix6& covariance, const Eigen::Matrix3d& turn);

/// Sizes of motion errors to expect, for station_gate_rad().
struct StationGateOptions {
  double point_u_mm = 0.3e-3;  ///< Standard uncertainty of a point that is wanted.
  double shift_mm = 3e-3;      ///< Amplitude of the shifts that depend on the angle.
  double tilt_rad = 15e-6;     ///< The same of the tilts.
  double order = 3.0;          ///< Their highest number of undulations per turn.
};

/// How far the other axis may stand off its zero while a station is measured, its reading taken
/// into account: its own errors then change by a tenth of the uncertainty wanted at most,
///   0.1 u_p / (K (A_t + A_w l)).
/// @param lever_mm  Largest distance of a ball from the axes, >= 0.
[[nodiscard]] double station_gate_rad(double lever_mm, const StationGateOptions& options = {});

/// Largest distance of a ball from the points of both axes.
/// @param balls_mm   Ball centres, from the point of the carried axis.
/// @param offset_mm  The point of the carried axis from that of the base-fixed one.
[[nodiscard]] double largest_lever_mm(std::span<const Eigen::Vector3d> balls_mm,
                                      const Eigen::Vector3d& offset_mm);

/// How far a reading may be from the command before the drive has failed:
///   4 sqrt(q^2 / 6 + s^2) + dead band.
[[nodiscard]] double drive_gate_rad(double count_rad, double repeatability_rad,
                                    double dead_band_rad);

}  // namespace rondure::fit
