#include "fit/poses/joint.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "core/decompositions.h"
#include "core/noise.h"
#include "core/statistics.h"
#include "fit/geometry/points.h"
#include "fit/least_squares/cylinder.h"
#include "fit/poses/internal/joint_model.h"
#include "fit/zone/fit.h"

namespace rondure::fit {
namespace {

using core::Code;
using core::fail;

constexpr int kFormPasses = 20;
/// A parameter with an uncertainty above this share of its prior counts as left to the kinematics.
constexpr double kFromPrior = 0.7;
/// Share of the targets touched in several poses below which what is left of the errors has no
/// uncertainty: of half shells that only meet (0.08) twice its value holds two thirds of the
/// errors.
constexpr double kLeastShared = 0.2;
constexpr double kWarnCondition = 30.0;  // half shells that just meet have 8, whole turns 3
constexpr std::array<std::string_view, 6> kNames = {"shift along x",        "shift along y",
                                                    "shift along the axis", "tilt about x",
                                                    "tilt about y",         "turn about the axis"};

core::Result<void> check(std::span<const JointPose> poses, const PoseJointOptions& options) {
  if (!(options.touch_mm > 0.0) || options.lobes < 2 || options.lobes > 30 ||
      !(options.draws == 0 || (options.draws >= 10 && options.draws <= 10'000)) ||
      !(options.condition_limit > 1.0)) {
    return fail_with(Code::kBadOption,
                     "joint poses: touch {} mm (above 0), lobes {} (2..30), draws {} (0 or "
                     "10..10000), condition limit {} (above 1)",
                     options.touch_mm, options.lobes, options.draws, options.condition_limit);
  }
  if (poses.size() < 2) {
    return fail_with(Code::kTooFewPoints, "joint poses: {} poses, at least 2 are needed",
                     poses.size());
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const JointPose& pose = poses[k];
    if (pose.touches.size() < 4) {
      return fail_with(
          Code::kTooFewPoints,
          "pose {}: {} touches, its four parameters that a cylinder shows need at least 4", k + 1,
          pose.touches.size());
    }
    if (!pose.X_WB.matrix().allFinite() || !pose.pivot_W_mm.allFinite()) {
      return fail_with(Code::kNotFinite, "pose {}: its motion is not a number", k + 1);
    }
    for (const double u : pose.prior) {
      if (std::isfinite(u) && u >= 0.0) continue;
      return fail_with(Code::kBadOption, "pose {}: prior uncertainty {} of an error, at least 0",
                       k + 1, u);
    }
    for (std::size_t i = 0; i < pose.touches.size(); ++i) {
      if (check_points(std::span(&pose.touches[i].tip_W_mm, 1))) continue;
      return fail_with(Code::kNotFinite, "pose {}: touch {} is not a number", k + 1, i);
    }
  }
  return {};
}

std::vector<Eigen::Vector3d> by_kinematics(std::span<const JointPose> poses) {
  std::vector<Eigen::Vector3d> points;
  for (const JointPose& pose : poses) {
    const Eigen::Isometry3d X_BW = pose.X_WB.inverse();
    for (const PoseTouch& touch : pose.touches) points.push_back(X_BW * touch.tip_W_mm);
  }
  return points;
}

core::Result<void> check_rank(const JointRank& rank, double limit) {
  if (rank.condition <= limit) return {};
  // `parameter` is one of the four of the model: shifts x, y, tilts x, y.
  const auto name = kNames[static_cast<std::size_t>(rank.parameter + (rank.parameter > 1 ? 1 : 0))];
  return fail_with(Code::kRank,
                   "the poses do not identify their errors (condition {:.3g}, limit {:.3g}): the "
                   "touches of pose {} show the {} of the part least; {}",
                   rank.condition, limit, rank.pose + 1, name,
                   rank.parameter > 1
                       ? "touch it there in at least two layers far apart, around the part"
                       : "touch it there on a wider arc, 90 deg or more around the part");
}

/// Solves and estimates the size of the form from the residuals, repeatedly until it settles.
core::Result<Eigen::VectorXd> settle_form(JointModel& model, double touch_mm) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(model.unknowns());
  for (int pass = 0; pass < kFormPasses; ++pass) {
    if (!solve_joint(model, x)) break;
    const Eigen::VectorXd d = model.deviations(x);
    const double freedom = std::max(1.0, static_cast<double>(d.size()) - 5.0);
    const double square = d.squaredNorm() / freedom - touch_mm * touch_mm;
    // For a part without form, a hundredth of the noise keeps the equations regular.
    const double form = std::sqrt(std::max(square, 1e-4 * touch_mm * touch_mm));
    const bool settled = std::abs(form - model.form_mm()) <= 1e-3 * form;
    if (settled) return x;
    // The amplitudes are in units of the form; rescaling keeps their values in mm.
    x.segment(JointModel::kCylinder, model.pose_column(0) - JointModel::kCylinder) *=
        model.form_mm() / form;
    model.set_form(form);
  }
  return fail_with(Code::kNotConverged, "part and poses: no solution that holds in {} passes",
                   kFormPasses);
}

/// Covariance of the unknowns of all poses, in units of their priors.
Eigen::MatrixXd pose_covariance(const JointModel& model, const Eigen::VectorXd& x) {
  Eigen::VectorXd residuals(model.residuals());
  JointModel::RowMatrix derivatives(model.residuals(), model.unknowns());
  model.evaluate(x, residuals, &derivatives);
  // The unknowns of the cylinder are in mm, all others near 1, so they are scaled before inversion.
  const Eigen::VectorXd size = derivatives.colwise().norm().cwiseMax(1e-300).transpose();
  const Eigen::MatrixXd scaled = derivatives * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd normal = scaled.transpose() * scaled;
  const Eigen::MatrixXd inverse = core::inverse_ldlt(normal);
  const int m = 6 * model.pose_count();
  const Eigen::VectorXd s = size.tail(m).cwiseInverse();
  const Eigen::MatrixXd block = s.asDiagonal() * inverse.bottomRightCorner(m, m) * s.asDiagonal();
  return 0.5 * (block + block.transpose());
}

void set_errors(const JointModel& model, const Eigen::VectorXd& x, const Eigen::MatrixXd& unit,
                PoseJoint& joint) {
  const int m = model.pose_count();
  Eigen::MatrixXd map = Eigen::MatrixXd::Zero(6 * m, 6 * m);
  for (int k = 0; k < m; ++k) map.block<6, 6>(6 * k, 6 * k) = model.error_of_unknowns(k);
  joint.covariance = map * unit * map.transpose();
  const Eigen::MatrixXd prior = map * map.transpose();
  const Eigen::VectorXd error = map * x.tail(6 * m);
  const auto variance = [](const Eigen::MatrixXd& c, int k, int i) {
    return std::max(0.0, c(i, i) + c(6 * k + i, 6 * k + i) - 2.0 * c(i, 6 * k + i));
  };
  joint.errors.resize(static_cast<std::size_t>(m));
  for (int k = 1; k < m; ++k) {
    PoseErrorFound& found = joint.errors[static_cast<std::size_t>(k)];
    found.error = error.segment<6>(6 * k) - error.head<6>();
    for (int i = 0; i < 6; ++i) {
      found.u(i) = std::sqrt(variance(joint.covariance, k, i));
      found.prior_u(i) = std::sqrt(variance(prior, k, i));
      found.from_kinematics[static_cast<std::size_t>(i)] =
          i % 3 == 2 || found.u(i) >= kFromPrior * found.prior_u(i);
    }
  }
}

/// Sets chi2 of the corrections, with the degrees of freedom and limit that correct priors imply in
/// the directions determined by the touches.
void set_chi2(const Eigen::VectorXd& z, const Eigen::MatrixXd& unit, PoseJoint& joint) {
  const Eigen::MatrixXd gained = Eigen::MatrixXd::Identity(z.size(), z.size()) - unit;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(gained);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double value = axes.eigenvalues()(i);
    if (value < 0.05) continue;
    const double along = axes.eigenvectors().col(i).dot(z);
    joint.chi2 += along * along / value;
    ++joint.chi2_freedom;
  }
  if (joint.chi2_freedom > 0) {
    joint.chi2_limit = core::chi_square_quantile(0.999, joint.chi2_freedom);
  }
}

/// Root mean square change of CYLt when the poses vary by random draws, given a square root of
/// their covariance.
double spread_mm(const JointModel& model, const Eigen::VectorXd& x, const Eigen::MatrixXd& root,
                 const PoseJoint& joint, int draws) {
  CylinderZoneFitter fitter;
  double squares = 0.0;
  for (int draw = 0; draw < draws; ++draw) {
    core::KeyedNoise noise(1, {0x706f7365, static_cast<std::uint64_t>(draw)});
    Eigen::VectorXd step(root.cols());
    for (Eigen::Index i = 0; i < step.size(); ++i) step(i) = noise.normal();
    Eigen::VectorXd there = x;
    there.tail(root.rows()) += root * step;
    const auto points = model.corrected(there);
    const double change = fitter.fit_from(points, joint.axis_B).width_mm() - joint.joint_mm;
    squares += change * change;
  }
  return draws > 0 ? std::sqrt(squares / draws) : 0.0;
}

core::Result<void> set_zones(const JointModel& model, const Eigen::VectorXd& x,
                             const Eigen::MatrixXd& unit, const PoseJointOptions& options,
                             PoseJoint& joint) {
  TRY(const auto cylinder, ls_cylinder(joint.joint_B_mm, options.axis_B));
  joint.axis_B = cylinder.axis;
  joint.radius_mm = cylinder.radius_mm;
  CylinderZoneFitter fitter;
  TRY(const auto naive, fitter.fit(joint.naive_B_mm, options.axis_B));
  joint.naive_mm = naive.width_mm();
  TRY(const auto zone, fitter.fit(joint.joint_B_mm, options.axis_B));
  joint.joint_mm = zone.width_mm();
  if (double(joint.shared) >= kLeastShared * double(model.targets()))
    joint.u_joint_mm = spread_mm(model, x, core::cholesky_root(unit), joint, options.draws);
  joint.u_naive_mm = spread_mm(model, x, Eigen::MatrixXd::Identity(unit.rows(), unit.rows()), joint,
                               options.draws);
  return {};
}

void set_statements(std::size_t targets, PoseJoint& joint) {
  auto& say = joint.statements;
  say.push_back(core::phrase(
      "shift along and turn about the axis of the part are those of the kinematics in every pose: "
      "a cylinder does not show them"));
  for (std::size_t k = 1; k < joint.errors.size(); ++k) {
    for (const int i : {0, 1, 3, 4}) {
      const PoseErrorFound& found = joint.errors[k];
      if (!found.from_kinematics[static_cast<std::size_t>(i)] || found.prior_u(i) == 0.0) continue;
      say.push_back(
          core::phrase("pose {}: the {} rests on the kinematics (the touches leave {:.0f} "
                       "% of their uncertainty); more targets touched in several poses "
                       "would show it",
                       k + 1, core::Phrase(kNames[static_cast<std::size_t>(i)]),
                       100.0 * found.u(i) / found.prior_u(i)));
    }
  }
  if (!joint.u_joint_mm) {
    say.push_back(core::phrase(
        "{} of {} targets were touched in more than one pose, {} are needed: form and errors of "
        "the poses are told apart only as far as the form is smooth, and what is left of the "
        "errors has no uncertainty",
        joint.shared, targets, std::ceil(kLeastShared * double(targets))));
  }
  if (joint.chi2 > joint.chi2_limit) {
    say.push_back(
        core::phrase("the poses were off by more than the kinematics state (chi2 {:.1f} "
                     "of {} degrees of freedom, limit {:.1f}): calibrate the fixture again",
                     joint.chi2, joint.chi2_freedom, joint.chi2_limit));
  }
  if (joint.condition > kWarnCondition) {
    say.push_back(
        core::phrase("the touches see the poses weakly (condition {:.0f}, good below {:.0f}): "
                     "a wider arc or layers farther apart would help",
                     joint.condition, kWarnCondition));
  }
}

}  // namespace

core::Result<PoseJoint> pose_joint(std::span<const JointPose> poses,
                                   const PoseJointOptions& options) {
  TRY_DO(check(poses, options));
  PoseJoint joint;
  joint.naive_B_mm = by_kinematics(poses);
  TRY(const auto start, ls_cylinder(joint.naive_B_mm, options.axis_B));
  JointModel model(poses, options, start);
  const JointRank rank = joint_rank(model);
  TRY_DO(check_rank(rank, options.condition_limit));
  TRY(const auto x, settle_form(model, options.touch_mm));
  joint.condition = rank.condition;
  joint.shared = model.shared();
  joint.form_mm = model.form_mm();
  joint.joint_B_mm = model.corrected(x);
  for (int k = 0; k < model.pose_count(); ++k) joint.X_WB.push_back(model.motion(x, k));
  const Eigen::MatrixXd unit = pose_covariance(model, x);
  set_errors(model, x, unit, joint);
  set_chi2(x.tail(unit.rows()), unit, joint);
  TRY_DO(set_zones(model, x, unit, options, joint));
  set_statements(model.targets(), joint);
  return joint;
}

}  // namespace rondure::fit
