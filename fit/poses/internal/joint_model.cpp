#include "fit/poses/internal/joint_model.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fit/rotary/errors.h"

namespace rondure::fit {
namespace {

/// Shares of the variance of the form: lobes times heights, taper with barrel and bend, and the
/// separate part of each spot. Results hardly depend on them, as the tests of pose_joint() show.
constexpr double kLobeShare = 0.75;
constexpr double kLengthShare = 0.20;
constexpr double kSpotShare = 0.05;

/// J of exp(w + dw) = exp(w) exp(J dw). The angles here are far below 0.01 rad, so that the series
/// is exact to the last bit.
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& w) {
  const Eigen::Matrix3d m = cross_matrix(w);
  const double square = w.squaredNorm();
  return Eigen::Matrix3d::Identity() - (0.5 - square / 24.0) * m +
         (1.0 / 6.0 - square / 120.0) * m * m;
}

/// The part frame: z along the axis, x as near as possible to body x, origin amid the points.
Eigen::Isometry3d part_frame(const Axis& axis, const Eigen::Vector3d& nominal) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d z =
      axis.direction.dot(nominal) < 0.0 ? Eigen::Vector3d(-axis.direction) : axis.direction;
  const Eigen::Vector3d hint =
      std::abs(z.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d x = (hint - hint.dot(z) * z).normalized();
  frame.linear().col(0) = x;
  frame.linear().col(1) = z.cross(x);
  frame.linear().col(2) = z;
  frame.translation() = axis.point_mm;
  return frame;
}

}  // namespace

struct JointModel::Place {
  Eigen::Vector3d p_P;      // the tip in the part frame, corrected
  Eigen::Vector3d out_P;    // unit vector from the axis
  double distance_mm;       // from the axis
  double along;             // on the axis, in half lengths
  Eigen::Matrix3d turn_PW;  // from the machine, corrected
  Eigen::Vector3d arm_W;    // from the pivot, for the rotation of the pose
};

JointModel::JointModel(std::span<const JointPose> poses, const PoseJointOptions& options,
                       const LsCylinder& start)
    : X_BP_(part_frame(start.axis, options.axis_B)),
      radius_mm_(start.radius_mm),
      touch_mm_(options.touch_mm),
      form_mm_(std::max(start.rms_mm, options.touch_mm)) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    poses_.push_back({poses[k].X_WB, poses[k].prior, poses[k].pivot_W_mm, {}});
    for (const PoseTouch& touch : poses[k].touches) {
      tips_W_.push_back(touch.tip_W_mm);
      pose_of_.push_back(static_cast<int>(k));
    }
  }
  group_targets(poses);
  set_form_columns(options);
}

void JointModel::group_targets(std::span<const JointPose> poses) {
  std::map<int, std::vector<int>> of_target;
  int row = 0;
  for (const JointPose& pose : poses) {
    for (const PoseTouch& touch : pose.touches) of_target[touch.target].push_back(row++);
  }
  for (auto& [target, rows] : of_target) groups_.push_back(std::move(rows));
}

std::size_t JointModel::shared() const {
  std::size_t count = 0;
  for (const auto& rows : groups_) {
    const bool several =
        std::ranges::any_of(rows, [&](int row) { return pose_of(row) != pose_of(rows.front()); });
    count += several ? 1 : 0;
  }
  return count;
}

// The columns belong to the places by the kinematics: an error of a few um there changes the form
// by some 1e-7 of its size.
void JointModel::set_form_columns(const PoseJointOptions& options) {
  const int n = touches();
  std::vector<Eigen::Vector3d> points_P;
  double top = 0.0;
  for (int i = 0; i < n; ++i) {
    const auto& pose = poses_[static_cast<std::size_t>(pose_of(i))];
    points_P.emplace_back(X_BP_.inverse() * (pose.X_WB.inverse() * tips_W_[std::size_t(i)]));
    top = std::max(top, std::abs(points_P.back().z()));
  }
  half_length_mm_ = std::max(top, 1e-3);
  double total = 0.0;
  for (int lobe = 2; lobe <= options.lobes; ++lobe) total += 1.0 / (lobe * lobe);
  form_.resize(n, 6 * (options.lobes - 1) + 4);
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d& p = points_P[static_cast<std::size_t>(i)];
    const double angle = std::atan2(p.y(), p.x());
    const double q = p.z() / half_length_mm_;
    const double bow = q * q - 1.0 / 3.0;
    int column = 0;
    for (int lobe = 2; lobe <= options.lobes; ++lobe) {
      // Three heights share the variance of a lobe.
      const double size = std::sqrt(kLobeShare / total / 3.0) / lobe * std::sqrt(2.0);
      for (const double height : {std::sqrt(0.5), q, bow}) {
        form_(i, column++) = size * height * std::cos(lobe * angle);
        form_(i, column++) = size * height * std::sin(lobe * angle);
      }
    }
    const double length = std::sqrt(kLengthShare);
    form_.row(i).tail<4>() << length * q, length * bow, length * bow * std::cos(angle),
        length * bow * std::sin(angle);
  }
}

Eigen::Isometry3d JointModel::error(const Eigen::VectorXd& x, int pose) const {
  const JointPose& at = poses_[static_cast<std::size_t>(pose)];
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> u(at.prior.data());
  const Eigen::Matrix<double, 6, 1> e = u.cwiseProduct(x.segment<6>(pose_column(pose)));
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = error_motion(Eigen::Vector3d::Zero(), e.tail<3>()).linear();
  motion.translation() = at.pivot_W_mm + e.head<3>() - motion.linear() * at.pivot_W_mm;
  return motion;
}

Eigen::Isometry3d JointModel::motion(const Eigen::VectorXd& x, int pose) const {
  return error(x, pose) * poses_[static_cast<std::size_t>(pose)].X_WB;
}

std::vector<Eigen::Vector3d> JointModel::corrected(const Eigen::VectorXd& x) const {
  std::vector<Eigen::Isometry3d> back;
  for (int k = 0; k < pose_count(); ++k) back.push_back(motion(x, k).inverse());
  std::vector<Eigen::Vector3d> points;
  points.reserve(tips_W_.size());
  for (std::size_t i = 0; i < tips_W_.size(); ++i) {
    points.push_back(back[static_cast<std::size_t>(pose_of_[i])] * tips_W_[i]);
  }
  return points;
}

JointModel::Place JointModel::place(const Eigen::VectorXd& x, int touch) const {
  const int k = pose_of(touch);
  const JointPose& pose = poses_[static_cast<std::size_t>(k)];
  const Eigen::Isometry3d X_WE = error(x, k);
  const Eigen::Isometry3d X_PW = (pose.X_WB * X_BP_).inverse();
  Place at;
  const Eigen::Vector3d& tip = tips_W_[static_cast<std::size_t>(touch)];
  at.p_P = X_PW * (X_WE.inverse() * tip);
  at.turn_PW = X_PW.linear() * X_WE.linear().transpose();
  at.arm_W = X_WE.linear() * (X_WE.inverse() * tip - pose.pivot_W_mm);
  const Eigen::Vector3d foot(x(0), x(1), 0.0);
  const Eigen::Vector3d along(x(2) / half_length_mm_, x(3) / half_length_mm_, 1.0);
  const Eigen::Vector3d from = at.p_P - foot;
  const double share = from.dot(along) / along.squaredNorm();
  const Eigen::Vector3d across = from - share * along;
  at.distance_mm = across.norm();
  at.out_P = across / at.distance_mm;
  at.along = share / half_length_mm_;
  return at;
}

Eigen::VectorXd JointModel::deviations(const Eigen::VectorXd& x) const {
  Eigen::VectorXd d(touches());
  for (int i = 0; i < touches(); ++i) d(i) = place(x, i).distance_mm - radius_mm_ - x(4);
  return d;
}

void JointModel::evaluate(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> residuals,
                          RowMatrix* derivatives) const {
  const int n = touches();
  const auto form = x.segment(kCylinder, form_.cols());
  if (derivatives != nullptr) derivatives->setZero();
  for (int i = 0; i < n; ++i) {
    const Place at = place(x, i);
    residuals(i) = at.distance_mm - radius_mm_ - x(4) - form_mm_ * form_.row(i).dot(form);
    if (derivatives == nullptr) continue;
    const int k = pose_of(i);
    auto row = derivatives->row(i);
    row.head<kCylinder>() << -at.out_P.x(), -at.out_P.y(), -at.along * at.out_P.x(),
        -at.along * at.out_P.y(), -1.0;
    row.segment(kCylinder, form_.cols()) = -form_mm_ * form_.row(i);
    const auto& pose = poses_[static_cast<std::size_t>(k)];
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> u(pose.prior.data());
    const Eigen::Vector3d w = u.tail<3>().cwiseProduct(x.segment<3>(pose_column(k) + 3));
    // p = E^-1 tip: a shift moves it by -exp(-w), a rotation by exp(-w) [arm]x J(-w).
    const Eigen::RowVector3d out_W = at.out_P.transpose() * at.turn_PW;
    row.segment<3>(pose_column(k)) = -out_W.cwiseProduct(u.head<3>().transpose());
    row.segment<3>(pose_column(k) + 3) =
        (out_W * cross_matrix(at.arm_W) * right_jacobian(-w)).cwiseProduct(u.tail<3>().transpose());
  }
  whiten(residuals, derivatives);
  const int priors = unknowns() - kCylinder;
  residuals.tail(priors) = x.tail(priors);
  if (derivatives != nullptr) derivatives->bottomRightCorner(priors, priors).setIdentity();
}

// Touches of one spot share its separate part of the form, with variance g, and each has noise of
// variance s. The inverse square root of s I + g 1 1^T is (I - c/m 1 1^T) / sqrt(s), with
// c = 1 - 1/sqrt(1 + m g/s).
void JointModel::whiten(Eigen::Ref<Eigen::VectorXd> residuals, RowMatrix* derivatives) const {
  const double ratio = kSpotShare * form_mm_ * form_mm_ / (touch_mm_ * touch_mm_);
  for (const auto& rows : groups_) {
    const auto m = static_cast<double>(rows.size());
    const double c = 1.0 - 1.0 / std::sqrt(1.0 + m * ratio);
    double mean = 0.0;
    for (const int i : rows) mean += residuals(i) / m;
    for (const int i : rows) residuals(i) = (residuals(i) - c * mean) / touch_mm_;
    if (derivatives == nullptr) continue;
    Eigen::RowVectorXd mean_row = Eigen::RowVectorXd::Zero(derivatives->cols());
    for (const int i : rows) mean_row += derivatives->row(i) / m;
    for (const int i : rows) {
      derivatives->row(i) = (derivatives->row(i) - c * mean_row) / touch_mm_;
    }
  }
}

Eigen::Matrix<double, 6, 6> JointModel::error_of_unknowns(int pose) const {
  const JointPose& at = poses_[static_cast<std::size_t>(pose)];
  const Eigen::Isometry3d X_WP = at.X_WB * X_BP_;
  const Eigen::Matrix3d turn_PW = X_WP.linear().transpose();
  Eigen::Matrix<double, 6, 6> map = Eigen::Matrix<double, 6, 6>::Zero();
  map.topLeftCorner<3, 3>() = turn_PW;
  map.topRightCorner<3, 3>() = -turn_PW * cross_matrix(X_WP.translation() - at.pivot_W_mm);
  map.bottomRightCorner<3, 3>() = turn_PW;
  const Eigen::Map<const Eigen::Matrix<double, 6, 1>> u(at.prior.data());
  return map * u.asDiagonal();
}

Eigen::Matrix<double, Eigen::Dynamic, 5> JointModel::seen() const {
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(unknowns());
  Eigen::Matrix<double, Eigen::Dynamic, 5> columns(touches(), 5);
  for (int i = 0; i < touches(); ++i) {
    const Place at = place(still, i);
    const Eigen::Vector3d turn = at.p_P.cross(at.out_P) / half_length_mm_;
    columns.row(i) << at.out_P.x(), at.out_P.y(), turn.x(), turn.y(), 1.0;
  }
  return columns;
}

}  // namespace rondure::fit
