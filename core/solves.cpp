#include <Eigen/LU>
#include <Eigen/SVD>

#include "core/decompositions.h"

namespace rondure::core {

using Eigen::MatrixXd;
using Eigen::VectorXd;

template <int N>
Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& matrix,
                                       const Eigen::Matrix<double, N, 1>& right) {
  return matrix.ldlt().solve(right);
}

template <int N>
Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::LDLT<Eigen::Matrix<double, N, N>>& factors,
                                       const Eigen::Matrix<double, N, 1>& right) {
  return factors.solve(right);
}

template Eigen::Matrix<double, 3, 1> solve_ldlt(const Eigen::Matrix<double, 3, 3>&,
                                                const Eigen::Matrix<double, 3, 1>&);
template Eigen::Matrix<double, 3, 1> solve_ldlt(const Eigen::LDLT<Eigen::Matrix<double, 3, 3>>&,
                                                const Eigen::Matrix<double, 3, 1>&);
template Eigen::Matrix<double, 4, 1> solve_ldlt(const Eigen::Matrix<double, 4, 4>&,
                                                const Eigen::Matrix<double, 4, 1>&);
template Eigen::Matrix<double, 4, 1> solve_ldlt(const Eigen::LDLT<Eigen::Matrix<double, 4, 4>>&,
                                                const Eigen::Matrix<double, 4, 1>&);
template Eigen::Matrix<double, 5, 1> solve_ldlt(const Eigen::Matrix<double, 5, 5>&,
                                                const Eigen::Matrix<double, 5, 1>&);
template Eigen::Matrix<double, 5, 1> solve_ldlt(const Eigen::LDLT<Eigen::Matrix<double, 5, 5>>&,
                                                const Eigen::Matrix<double, 5, 1>&);
template Eigen::Matrix<double, 6, 1> solve_ldlt(const Eigen::Matrix<double, 6, 6>&,
                                                const Eigen::Matrix<double, 6, 1>&);
template Eigen::Matrix<double, 6, 1> solve_ldlt(const Eigen::LDLT<Eigen::Matrix<double, 6, 6>>&,
                                                const Eigen::Matrix<double, 6, 1>&);
template Eigen::Matrix<double, Eigen::Dynamic, 1> solve_ldlt(
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>&,
    const Eigen::Matrix<double, Eigen::Dynamic, 1>&);
template Eigen::Matrix<double, Eigen::Dynamic, 1> solve_ldlt(
    const Eigen::LDLT<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>>&,
    const Eigen::Matrix<double, Eigen::Dynamic, 1>&);

template <int N>
Eigen::Matrix<double, N, N> inverse_ldlt(const Eigen::Matrix<double, N, N>& matrix) {
  return matrix.ldlt().solve(Eigen::Matrix<double, N, N>::Identity(matrix.rows(), matrix.cols()));
}

template Eigen::Matrix<double, 6, 6> inverse_ldlt(const Eigen::Matrix<double, 6, 6>&);
template MatrixXd inverse_ldlt(const MatrixXd&);

VectorXd solve_llt(const MatrixXd& matrix, const VectorXd& right) {
  return matrix.llt().solve(right);
}

MatrixXd cholesky_root(const MatrixXd& matrix) { return matrix.llt().matrixL(); }

MatrixXd inverse_lu(const MatrixXd& matrix) { return matrix.inverse(); }

SingularVectors singular_vectors(const MatrixXd& matrix) {
  const Eigen::JacobiSVD<MatrixXd> split(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {split.matrixU(), split.matrixV()};
}

VectorXd solve_pivoted_qr(const MatrixXd& matrix, const VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

MatrixXd solve_pivoted_qr(const MatrixXd& matrix, const MatrixXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

std::optional<VectorXd> solve_if_regular(const MatrixXd& matrix, const VectorXd& right) {
  const Eigen::ColPivHouseholderQR<MatrixXd> factors(matrix);
  if (!factors.isInvertible()) return std::nullopt;
  return VectorXd(factors.solve(right));
}

MatrixXd column_space(const MatrixXd& matrix, double threshold) {
  Eigen::ColPivHouseholderQR<MatrixXd> factors(matrix);
  factors.setThreshold(threshold);
  return factors.householderQ() * MatrixXd::Identity(matrix.rows(), factors.rank());
}

MatrixXd full_q(const MatrixXd& matrix) {
  const Eigen::HouseholderQR<MatrixXd> factors(matrix);
  return factors.householderQ() * MatrixXd::Identity(matrix.rows(), matrix.rows());
}

ThinQr thin_qr(const MatrixXd& matrix) {
  const Eigen::HouseholderQR<MatrixXd> factors(matrix);
  ThinQr out;
  out.q = factors.householderQ() * MatrixXd::Identity(matrix.rows(), matrix.cols());
  out.r = factors.matrixQR().topRows(matrix.cols()).triangularView<Eigen::Upper>();
  return out;
}

VectorXd solve_qr(const Eigen::HouseholderQR<MatrixXd>& factors, const VectorXd& right) {
  return factors.solve(right);
}

VectorXd q_times(const Eigen::HouseholderQR<MatrixXd>& factors, const VectorXd& v) {
  return factors.householderQ() * v;
}

VectorXd q_transposed_times(const Eigen::HouseholderQR<MatrixXd>& factors, const VectorXd& v) {
  return factors.householderQ().adjoint() * v;
}

}  // namespace rondure::core
