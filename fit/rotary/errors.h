#pragma once

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

}  // namespace rondure::fit
