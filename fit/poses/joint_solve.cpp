#include <cmath>
#include <limits>

#include <ceres/ceres.h>

#include "core/decompositions.h"
#include "fit/poses/internal/joint_model.h"

namespace rondure::fit {
namespace {

/// All residuals as one function of all unknowns; each depends on the part, so nothing is sparse.
class JointCost final : public ceres::CostFunction {
 public:
  explicit JointCost(const JointModel& model) : model_(model) {
    set_num_residuals(model.residuals());
    mutable_parameter_block_sizes()->push_back(model.unknowns());
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(parameters[0], model_.unknowns());
    Eigen::Map<Eigen::VectorXd> r(residuals, model_.residuals());
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      model_.evaluate(x, r, nullptr);
      return true;
    }
    JointModel::RowMatrix derivatives(model_.residuals(), model_.unknowns());
    model_.evaluate(x, r, &derivatives);
    Eigen::Map<JointModel::RowMatrix>(jacobians[0], model_.residuals(), model_.unknowns()) =
        derivatives;
    return true;
  }

 private:
  const JointModel& model_;
};

}  // namespace

bool solve_joint(const JointModel& model, Eigen::VectorXd& x) {
  ceres::Problem problem;
  problem.AddResidualBlock(new JointCost(model), nullptr, x.data());  // the problem owns the cost
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.dense_linear_algebra_library_type = ceres::EIGEN;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 100;
  // The problem is nearly linear: the unknowns converge to 1e-9 of their priors in a few steps.
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-11;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE &&
         x.allFinite();
}

JointRank joint_rank(const JointModel& model) {
  JointRank rank;
  const Eigen::Matrix<double, Eigen::Dynamic, 5> seen = model.seen();
  const int poses = model.pose_count();
  // The first pose is held fixed, as the cylinder takes up errors common to all poses.
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(model.touches(), 5 + 4 * (poses - 1));
  jacobian.leftCols(5) = seen;
  for (int i = 0; i < model.touches(); ++i) {
    const int k = model.pose_of(i);
    if (k > 0) jacobian.row(i).segment<4>(5 + 4 * (k - 1)) = seen.row(i).head<4>();
  }
  // All columns are in mm at the surface, tilts at the half length of the part. They are not scaled
  // further, so that an almost vanishing column counts as such.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> values(jacobian.transpose() * jacobian,
                                                              Eigen::EigenvaluesOnly);
  const double least = values.eigenvalues()(0);
  rank.condition = least > 0.0 ? std::sqrt(values.eigenvalues().tail<1>()(0) / least)
                               : std::numeric_limits<double>::infinity();
  double smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < poses; ++k) {
    Eigen::Matrix4d sums = Eigen::Matrix4d::Zero();
    for (int i = 0; i < model.touches(); ++i) {
      if (model.pose_of(i) == k) sums += seen.row(i).head<4>().transpose() * seen.row(i).head<4>();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> of_pose(sums);
    if (of_pose.eigenvalues()(0) >= smallest) continue;
    smallest = of_pose.eigenvalues()(0);
    rank.pose = k;
    of_pose.eigenvectors().col(0).cwiseAbs().maxCoeff(&rank.parameter);
  }
  return rank;
}

}  // namespace rondure::fit
