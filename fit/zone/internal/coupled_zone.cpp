#include "fit/zone/internal/coupled_zone.h"

#include "core/decompositions.h"

namespace rondure::fit {

OptimumEquations::OptimumEquations(Eigen::Index place, Eigen::Index bounds, std::size_t contacts)
    : place_(place), primal_(place + bounds) {
  const Eigen::Index unknowns = primal_ + static_cast<Eigen::Index>(contacts);
  system_ = Eigen::MatrixXd::Zero(unknowns, unknowns);
  right_ = Eigen::VectorXd::Zero(unknowns);
  right_.segment(place, bounds).setOnes();
}

void OptimumEquations::set(std::size_t i, const CoupledContact& contact, double sign,
                           const MeasuredRow& row, double value) {
  const Eigen::Index at = primal_ + static_cast<Eigen::Index>(i);
  const Eigen::Index bound = place_ + static_cast<Eigen::Index>(contact.bound);
  system_.topLeftCorner(place_, place_) += contact.multiplier * sign * row.hessian;
  system_.block(0, at, place_, 1) = sign * row.gradient;
  system_(bound, at) = 1.0;
  system_.block(at, 0, 1, place_) = -row.gradient.transpose();
  system_(at, bound) = 1.0;
  right_(at) = row.value - value;
}

std::optional<Eigen::VectorXd> OptimumEquations::solution() const {
  return core::solve_if_regular(system_, right_);
}

Eigen::VectorXd OptimumEquations::least_solution() const {
  constexpr double kSingular = 1e-12;  // of the squares of the singular values
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(system_ * system_.transpose());
  const double least = kSingular * squares.eigenvalues().maxCoeff();
  Eigen::VectorXd along = squares.eigenvectors().transpose() * right_;
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    along(i) = squares.eigenvalues()(i) > least ? along(i) / squares.eigenvalues()(i) : 0.0;
  }
  return system_.transpose() * (squares.eigenvectors() * along);
}

Eigen::MatrixXd without_negative_part(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(matrix);
  return principal.eigenvectors() * principal.eigenvalues().cwiseMax(0.0).asDiagonal() *
         principal.eigenvectors().transpose();
}

Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& normals) {
  constexpr double kDependent = 1e-10;
  if (normals.cols() == 0) return Eigen::MatrixXd::Identity(normals.rows(), normals.rows());
  const Eigen::MatrixXd columns = core::column_space(normals, kDependent);
  return core::full_q(columns).rightCols(normals.rows() - columns.cols());
}

Eigen::VectorXd part_along(const Eigen::MatrixXd& columns, const Eigen::VectorXd& v) {
  return columns * (columns.transpose() * v);
}

double least_curvature(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd reduced = columns.transpose() * matrix * columns;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> principal(reduced);
  return principal.eigenvalues()(0);
}

}  // namespace rondure::fit
