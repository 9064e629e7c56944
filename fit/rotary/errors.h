#pragma once

#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace rondure::fit {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix36 = Eigen::Matrix<double, 3, 6>;

/// The nominal line of a rotary axis, in the frame of the measuring machine.
struct RotaryAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< Unit vector; turns right-handed.
  Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();   ///< Point to which translations refer.

  /// The nominal rotation about the direction.
  [[nodiscard]] Eigen::Matrix3d turn(double angle_rad) const {
    return Eigen::AngleAxisd(angle_rad, direction).toRotationMatrix();
  }
};

/// The six errors of a rotary axis at one angle. In addition to the nominal rotation, the body is
/// shifted by t and rotated by w about the origin of the axis:
///   p_actual = exp([w]x) R(angle) p0 + t,    p relative to the origin of the axis.
struct RotaryErrors {
  Eigen::Vector3d t_mm = Eigen::Vector3d::Zero();   ///< Errors along x, y, z (EX, EY, EZ) [mm].
  Eigen::Vector3d w_rad = Eigen::Vector3d::Zero();  ///< Errors about x, y, z (EA, EB, EC) [rad].
  Matrix6 covariance = Matrix6::Zero();             ///< Covariance of (t; w): mm^2, mm rad, rad^2.
  bool bridged = false;  ///< Interpolated across a station without a solution.

  [[nodiscard]] Vector6 values() const {
    Vector6 out;
    out << t_mm, w_rad;
    return out;
  }
  /// Standard uncertainty of each of (t; w) [mm, rad].
  [[nodiscard]] Vector6 sigma() const { return covariance.diagonal().cwiseMax(0.0).cwiseSqrt(); }
};

/// The error alone, exact: p -> exp([w]x) p + t, p relative to the origin of the axis [mm].
[[nodiscard]] Eigen::Isometry3d error_motion(const Eigen::Vector3d& t_mm,
                                             const Eigen::Vector3d& w_rad);

/// The true motion of the body for a turn of `angle_rad` (counted from the reference pose) with
/// these errors, in the frame of the machine: a point of the body at x_mm in the reference pose
/// moves to rotary_motion(...) * x_mm. The inverse maps points measured at the angle back to the
/// reference pose.
[[nodiscard]] Eigen::Isometry3d rotary_motion(const RotaryAxis& axis, double angle_rad,
                                              const RotaryErrors& errors);

/// The vector w with exp([w]x) = rotation, |w| <= pi.
[[nodiscard]] Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& rotation);

/// Matrix [v]x of the cross product: [v]x u = v x u.
[[nodiscard]] Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);

/// Covariance of the displacement t + w x p of a point by errors of the given covariance [mm^2].
/// @param p_mm  The point at the angle of the errors, relative to the origin of the axis.
[[nodiscard]] Eigen::Matrix3d point_covariance_mm2(const Matrix6& covariance,
                                                   const Eigen::Vector3d& p_mm);

// What the readings of a two-axis fixture add to its errors, and the limits within which a station
// of one axis may be measured while the other does not stand at its zero.

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
