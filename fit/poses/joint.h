#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/axis.h"

namespace rondure::fit {

/// One touch of one pose.
struct PoseTouch {
  Eigen::Vector3d tip_W_mm = Eigen::Vector3d::Zero();  ///< Tip centre, machine frame [mm].
  /// Number of the place on the part. Touches of the same number, in whatever pose, meet the same
  /// spot of the surface and so the same form; a place touched in one pose only counts as well.
  int target = 0;
};

/// The touches of one pose and what the kinematics know of it.
struct JointPose {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();  ///< Body to machine, nominal or
                                                           ///< calibrated.
  /// Prior standard uncertainties of its six errors, machine frame: shift along x, y, z of the
  /// point `pivot_W_mm` [mm] and turn about x, y, z [rad]. 0: known exactly.
  std::array<double, 6> prior = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  Eigen::Vector3d pivot_W_mm = Eigen::Vector3d::Zero();  ///< Where the axes of the fixture meet.
  std::vector<PoseTouch> touches;
};

/// Settings of pose_joint(). A value outside its range gives Code::kBadOption.
struct PoseJointOptions {
  Eigen::Vector3d axis_B = Eigen::Vector3d::UnitZ();  ///< Nominal axis of the part; start value.
  double touch_mm = 0.1e-3;  ///< Standard uncertainty of one touch [mm]; > 0.
  int lobes = 10;            ///< Highest lobe number of the smooth form, 2..30.
  int draws = 100;           ///< Of the propagation into CYLt; 0: none, else 10..10000.
  double condition_limit =
      100.0;  ///< Of the scaled Jacobian; beyond it the poses are refused; > 1.
};

/// What was found of one pose against the first one, at the middle of the part, in the part frame:
/// z along the axis of the part, x as near to body x as can be. Of the first pose all is zero.
struct PoseErrorFound {
  /// Where the pose really was, seen from where the kinematics say: shift x, y, z [mm], turn about
  /// x, y, z [rad].
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 1> u = Eigen::Matrix<double, 6, 1>::Zero();  ///< Standard uncertainty.
  Eigen::Matrix<double, 6, 1> prior_u = Eigen::Matrix<double, 6, 1>::Zero();  ///< The kinematics'.
  /// Which of the six the touches say next to nothing about (u above 0.7 of the prior): they are
  /// those of the kinematics. Always the shift along and the turn about the axis.
  std::array<bool, 6> from_kinematics = {};
};

/// Part and poses, solved together.
struct PoseJoint {
  std::vector<Eigen::Vector3d> naive_B_mm;  ///< Tip centres by the kinematics alone, pose by pose.
  std::vector<Eigen::Vector3d> joint_B_mm;  ///< The same with the pose errors taken out.
  std::vector<Eigen::Isometry3d> X_WB;      ///< The motions that were found.
  std::vector<PoseErrorFound> errors;       ///< One for each pose.
  /// Of (shift, turn) of all poses at the middle of the part, part frame, 6 m x 6 m [mm, rad]. Not
  /// against the first pose: what all poses share stays as uncertain as the priors.
  Eigen::MatrixXd covariance;
  Axis axis_B;              ///< Least squares of the corrected touches.
  double radius_mm = 0.0;   ///< Of the tip centres.
  double form_mm = 0.0;     ///< Standard deviation of the form about the cylinder [mm].
  double condition = 0.0;   ///< Of the scaled Jacobian of cylinder and poses.
  std::size_t shared = 0;   ///< Targets touched in more than one pose.
  double chi2 = 0.0;        ///< Of the corrections against their priors.
  int chi2_freedom = 0;     ///< Its degrees of freedom: directions the touches say something on.
  double chi2_limit = 0.0;  ///< Its 0.999 quantile; a fixture worse than stated lies above it.
  double naive_mm = 0.0;    ///< CYLt (minimum zone) of naive_B_mm.
  double joint_mm = 0.0;    ///< CYLt of joint_B_mm.
  double u_joint_mm = 0.0;  ///< What is left of the fixture in it: root mean square of the change
                            ///< by the remaining uncertainty of the poses.
  double u_naive_mm = 0.0;  ///< The same for the priors: what the kinematics alone would do.
  std::vector<std::string> statements;  ///< In words: what rests on the kinematics, and warnings.

  /// What the fixture adds to CYLt when its errors are not solved for [mm].
  [[nodiscard]] double share_mm() const { return naive_mm - joint_mm; }
};

/// Solves the cylinder of a part and the small rigid errors of several fixture poses together.
///
/// Least squares, Ceres, of  d(E_k^-1 p) - r - h(place)  over the axis and radius of the part, the
/// errors E_k = (t, w) of each pose and the form h, with
/// - the priors of the kinematics on each t, w;
/// - h = lobes 2..`lobes` times heights 1, q, q^2, and taper, barrel, bend, amplitudes falling as
///   1/lobe, and a part of its own for each target. All of it common to all poses: a spot touched
///   in two poses must have one height, whatever the form, and a neighbour nearly the same;
/// - the size of h from the residuals themselves, repeated until it holds.
/// Then the minimum zone of the corrected touches; the form is never subtracted from them.
///
/// A cylinder does not see a turn about or a shift along its axis: these stay those of the
/// kinematics. Any other parameter must be seen by the touches, else kRank, which names pose,
/// parameter and cure.
///
/// How well (error of CYLt, median and 95 % of simulated parts; docs/several-poses.md): half shells
/// that overlap by 30 deg on each side 1.1 % and 4 %, by 15 deg 3 % and 12 %. With nothing shared a
/// shift of two half shells looks like two lobes: 13 % and 35 %, and `u_joint_mm` is too small, it
/// holds two thirds of the parts within twice itself; elsewhere 86 to 97 %.
///
/// @param poses  m >= 2.
/// @return  kTooFewPoints (fewer than 2 poses, 4 touches in a pose, or 8 in all), kNotFinite,
///          kBadOption (negative priors, options), kRank, those of ls_cylinder(), kNotConverged.
///          Same input, same bits. Cost: dense, O(n (6 lobes + 6 m)^2) a step; some 50 ms for 200
///          touches in 2 poses, most of it the draws.
/// Sources: methods, rotary_axes section 8, cylindricity section 3.
[[nodiscard]] core::Result<PoseJoint> pose_joint(std::span<const JointPose> poses,
                                                 const PoseJointOptions& options = {});

}  // namespace rondure::fit
