#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fit/least_squares/cylinder.h"
#include "fit/poses/joint.h"

namespace rondure::fit {

/// Residuals and derivatives of pose_joint(). Unknowns: 5 of the cylinder (shift x, y of its axis,
/// tilt toward x, y times the half length, radius), the amplitudes of the smooth form in units of
/// their prior, and six of each pose in units of their priors. Everything but the form is in mm.
class JointModel {
 public:
  using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  static constexpr int kCylinder = 5;

  /// @param start  Least-squares cylinder of the touches as the kinematics place them.
  JointModel(std::span<const JointPose> poses, const PoseJointOptions& options,
             const LsCylinder& start);

  [[nodiscard]] int touches() const { return static_cast<int>(tips_W_.size()); }
  [[nodiscard]] int unknowns() const { return pose_column(static_cast<int>(poses_.size())); }
  [[nodiscard]] int residuals() const { return touches() + unknowns() - kCylinder; }
  [[nodiscard]] int pose_column(int pose) const {
    return kCylinder + static_cast<int>(form_.cols()) + 6 * pose;
  }
  [[nodiscard]] int pose_count() const { return static_cast<int>(poses_.size()); }
  [[nodiscard]] int pose_of(int touch) const { return pose_of_[static_cast<std::size_t>(touch)]; }
  [[nodiscard]] std::size_t shared() const;
  [[nodiscard]] std::size_t targets() const { return groups_.size(); }
  [[nodiscard]] const Eigen::Isometry3d& X_BP() const { return X_BP_; }
  [[nodiscard]] double half_length_mm() const { return half_length_mm_; }
  [[nodiscard]] double form_mm() const { return form_mm_; }

  /// Sets the standard deviation of the form [mm].
  void set_form(double form_mm) { form_mm_ = form_mm; }

  /// Whitened residuals of the touches, then the priors; with derivatives if wanted.
  void evaluate(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> residuals,
                RowMatrix* derivatives) const;

  /// Distances of the touches from the cylinder of x, without the form [mm].
  [[nodiscard]] Eigen::VectorXd deviations(const Eigen::VectorXd& x) const;
  /// Tip centres in the body frame with the errors of the poses removed.
  [[nodiscard]] std::vector<Eigen::Vector3d> corrected(const Eigen::VectorXd& x) const;
  /// True motion of a pose, body to machine.
  [[nodiscard]] Eigen::Isometry3d motion(const Eigen::VectorXd& x, int pose) const;
  /// Matrix from the six unknowns of a pose to its error at the middle of the part, part frame.
  [[nodiscard]] Eigen::Matrix<double, 6, 6> error_of_unknowns(int pose) const;
  /// Derivatives of the distances with respect to shift x, y and tilt about x, y (times the half
  /// length) of the pose of each touch, at the place by the kinematics; column 4: the radius.
  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 5> seen() const;

 private:
  struct Place;  // of one touch
  [[nodiscard]] Place place(const Eigen::VectorXd& x, int touch) const;
  [[nodiscard]] Eigen::Isometry3d error(const Eigen::VectorXd& x, int pose) const;
  void set_form_columns(const PoseJointOptions& options);
  void group_targets(std::span<const JointPose> poses);
  void whiten(Eigen::Ref<Eigen::VectorXd> residuals, RowMatrix* derivatives) const;

  std::vector<JointPose> poses_;  // without their touches
  std::vector<Eigen::Vector3d> tips_W_;
  std::vector<int> pose_of_;
  std::vector<std::vector<int>> groups_;                    // touches of each target
  Eigen::Isometry3d X_BP_ = Eigen::Isometry3d::Identity();  // part frame in the body
  double half_length_mm_ = 1.0;
  double radius_mm_ = 0.0;
  double touch_mm_ = 0.0;
  double form_mm_ = 0.0;
  Eigen::MatrixXd form_;  // columns of the smooth form, share of its variance in them
};

/// Minimises the squares of the model's residuals from `x`.
/// @return Whether it converged.
[[nodiscard]] bool solve_joint(const JointModel& model, Eigen::VectorXd& x);

/// How well the touches determine the poses.
struct JointRank {
  double condition = 0.0;  ///< Condition of the Jacobian of cylinder and poses.
  int pose = 0;            ///< Pose that is determined worst.
  int parameter = 0;       ///< Its worst parameter: 0, 1: shift along x, y; 2, 3: tilt about x, y.
};
/// Columns of the Jacobian: radial move of the touches [mm] by each parameter, tilts at the half
/// length.
[[nodiscard]] JointRank joint_rank(const JointModel& model);

}  // namespace rondure::fit
