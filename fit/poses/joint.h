#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/geometry/axis.h"

namespace rondure::fit {

/// One touch of one pose.
struct PoseTouch {
  Eigen::Vector3d tip_W_mm = Eigen::Vector3d::Zero();  ///< Tip centre, machine frame [mm].
  /// Number of the place on the part. Touches with the same number, in any pose, meet the same spot
  /// of the surface and so the same form. A place touched in only one pose is allowed.
  int target = 0;
};

/// The touches of one pose, and the pose according to the kinematics.
struct JointPose {
  /// Body to machine, nominal or calibrated.
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  /// Prior standard uncertainties of its six errors, machine frame: shift along x, y, z of the
  /// point `pivot_W_mm` [mm] and turn about x, y, z [rad]. 0: known exactly.
  std::array<double, 6> prior = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  Eigen::Vector3d pivot_W_mm = Eigen::Vector3d::Zero();  ///< Intersection of the fixture axes.
  std::vector<PoseTouch> touches;
};

/// Settings of pose_joint(). A value outside its range gives Code::kBadOption.
struct PoseJointOptions {
  Eigen::Vector3d axis_B = Eigen::Vector3d::UnitZ();  ///< Nominal axis of the part; start value.
  double touch_mm = 0.1e-3;  ///< Standard uncertainty of one touch [mm]; > 0.
  int lobes = 10;            ///< Highest lobe number of the smooth form, 2..30.
  int draws = 100;           ///< Draws of the propagation into CYLt; 0: none, else 10..10000.
  double condition_limit =
      100.0;  ///< Greatest condition of the scaled Jacobian; above it, poses are refused; > 1.
};

/// Errors of one pose relative to the first one, at the middle of the part, in the part frame: z
/// along the axis of the part, x as near as possible to body x. All zero for the first pose.
struct PoseErrorFound {
  /// True pose relative to that of the kinematics: shift x, y, z [mm], turn about x, y, z [rad].
  Eigen::Matrix<double, 6, 1> error = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, 1> u = Eigen::Matrix<double, 6, 1>::Zero();  ///< Standard uncertainty.
  /// Standard uncertainty by kinematics alone.
  Eigen::Matrix<double, 6, 1> prior_u = Eigen::Matrix<double, 6, 1>::Zero();
  /// The errors that the touches hardly determine (u above 0.7 of the prior), so that their values
  /// are those of the kinematics. Always the shift along and the turn about the axis.
  std::array<bool, 6> from_kinematics = {};
};

/// Part and poses, from the joint solution.
struct PoseJoint {
  std::vector<Eigen::Vector3d> naive_B_mm;  ///< Tip centres by the kinematics alone, pose by pose.
  std::vector<Eigen::Vector3d> joint_B_mm;  ///< The same with the pose errors removed.
  std::vector<Eigen::Isometry3d> X_WB;      ///< The motions found.
  std::vector<PoseErrorFound> errors;       ///< One for each pose.
  /// Covariance of (shift, turn) of all poses at the middle of the part, part frame, 6 m x 6 m [mm,
  /// rad]. Not relative to the first pose: errors common to all poses stay as uncertain as the
  /// priors.
  Eigen::MatrixXd covariance;
  Axis axis_B;              ///< Least-squares axis of the corrected touches.
  double radius_mm = 0.0;   ///< Radius of the cylinder of tip centres.
  double form_mm = 0.0;     ///< Standard deviation of the form about the cylinder [mm].
  double condition = 0.0;   ///< Condition of the scaled Jacobian of cylinder and poses.
  std::size_t shared = 0;   ///< Number of targets touched in more than one pose.
  double chi2 = 0.0;        ///< Chi-square of the corrections relative to their priors.
  int chi2_freedom = 0;     ///< Its degrees of freedom: directions that the touches determine.
  double chi2_limit = 0.0;  ///< Its 0.999 quantile; a fixture worse than stated exceeds it.
  double naive_mm = 0.0;    ///< CYLt (minimum zone) of naive_B_mm.
  double joint_mm = 0.0;    ///< CYLt of joint_B_mm.
  /// Contribution of the fixture that remains in it: rms change of CYLt by the remaining
  /// uncertainty of the poses. Not known where less than a fifth of the targets was touched in
  /// several.
  std::optional<double> u_joint_mm;
  double u_naive_mm = 0.0;               ///< The same for the priors, as for the kinematics alone.
  std::vector<core::Phrase> statements;  ///< Errors left to the kinematics, and warnings, in words.

  /// Contribution of the fixture to CYLt if its errors are not solved for [mm].
  [[nodiscard]] double share_mm() const { return naive_mm - joint_mm; }
};

/// Solves the cylinder of a part and the small rigid errors of several fixture poses together.
///
/// Least squares, Ceres, of  d(E_k^-1 p) - r - h(place)  over the axis and radius of the part, the
/// errors E_k = (t, w) of each pose and the form h, with
/// - the priors of the kinematics on each t, w;
/// - h = lobes 2..`lobes` times heights 1, q, q^2, with taper, barrel and bend, amplitudes falling
///   as 1/lobe, and a separate part for each target. The form is common to all poses: a spot
///   touched in two poses has one height, whatever the form, and a neighbour nearly the same;
/// - the size of h estimated from the residuals, repeated until it no longer changes.
/// Then finds the minimum zone of the corrected touches; the form is never subtracted from them.
///
/// A turn about the axis and a shift along it stay those of the kinematics. The touches must
/// determine every other parameter; otherwise the result is kRank, and `what` names pose, parameter
/// and remedy.
///
/// Accuracy (docs/several-poses.md): half shells that overlap by 30 deg on each side give CYLt to
/// 1.1 % (median) and 4 % (95 %). With nothing shared, a shift of two half shells looks like two
/// lobes: 13 % and 35 %, and there is no `u_joint_mm`: it would be half of what it should be.
///
/// @param poses  m >= 2.
/// @return  kTooFewPoints (fewer than 2 poses, 4 touches in a pose, or 8 in all), kNotFinite,
///          kBadOption (negative priors, options), kRank, the errors of ls_cylinder(),
///          kNotConverged. Same input, same bits. Cost: dense, O(n (6 lobes + 6 m)^2) per step;
///          some 50 ms for 200 touches in 2 poses, most of it the draws.
/// Sources: methods, rotary_axes section 8, cylindricity section 3.
[[nodiscard]] core::Result<PoseJoint> pose_joint(std::span<const JointPose> poses,
                                                 const PoseJointOptions& options = {});

}  // namespace rondure::fit
