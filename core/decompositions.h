#pragma once

#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

namespace Eigen {

// Matrix decompositions that several files use, compiled once in decompositions.cpp. Each one costs
// g++ three to eight seconds in every file that instantiates it. Include this header in place of
// Eigen's.
extern template SelfAdjointEigenSolver<Matrix2d>& SelfAdjointEigenSolver<Matrix2d>::compute(
    const EigenBase<Matrix2d>&, int);
extern template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
extern template SelfAdjointEigenSolver<Matrix4d>& SelfAdjointEigenSolver<Matrix4d>::compute(
    const EigenBase<Matrix4d>&, int);
extern template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
extern template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template LDLT<Matrix3d>& LDLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
extern template LDLT<Matrix4d>& LDLT<Matrix4d>::compute(const EigenBase<Matrix4d>&);
extern template LDLT<Matrix<double, 5, 5>>& LDLT<Matrix<double, 5, 5>>::compute(
    const EigenBase<Matrix<double, 5, 5>>&);
extern template LDLT<Matrix<double, 6, 6>>& LDLT<Matrix<double, 6, 6>>::compute(
    const EigenBase<Matrix<double, 6, 6>>&);
extern template void ColPivHouseholderQR<MatrixXd>::computeInPlace();
extern template void HouseholderQR<MatrixXd>::computeInPlace();

}  // namespace Eigen

namespace rondure::core {

// Solutions with these decompositions, behind functions of plain matrices for the same reason. A
// matrix that is not regular gives what Eigen gives, numbers that are not finite included, unless
// the function says otherwise.

/// x of matrix x = right for a symmetric matrix, by LDLT. N: 3 to 6, or Eigen::Dynamic.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, 1> solve_ldlt(const Eigen::Matrix<double, N, N>& matrix,
                                                     const Eigen::Matrix<double, N, 1>& right);

/// The same with the factors of the matrix, for several right sides.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, 1> solve_ldlt(
    const Eigen::LDLT<Eigen::Matrix<double, N, N>>& factors,
    const Eigen::Matrix<double, N, 1>& right);

/// Inverse of a symmetric matrix by LDLT. N: 6 or Eigen::Dynamic.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, N> inverse_ldlt(const Eigen::Matrix<double, N, N>& matrix);

/// x of matrix x = right for a positive definite matrix, by Cholesky.
[[nodiscard]] Eigen::VectorXd solve_llt(const Eigen::MatrixXd& matrix,
                                        const Eigen::VectorXd& right);

/// Lower triangular L with matrix = L L^T for a positive definite matrix, by Cholesky.
[[nodiscard]] Eigen::MatrixXd cholesky_root(const Eigen::MatrixXd& matrix);

/// Inverse of a square matrix, by LU with partial pivoting.
[[nodiscard]] Eigen::MatrixXd inverse_lu(const Eigen::MatrixXd& matrix);

/// The orthonormal factors of matrix = u diag(singular values, falling) v^T, both square.
struct SingularVectors {
  Eigen::MatrixXd u;
  Eigen::MatrixXd v;
};
[[nodiscard]] SingularVectors singular_vectors(const Eigen::MatrixXd& matrix);

/// Least-squares solution of matrix x = right, by QR with column pivoting.
[[nodiscard]] Eigen::VectorXd solve_pivoted_qr(const Eigen::MatrixXd& matrix,
                                               const Eigen::VectorXd& right);
[[nodiscard]] Eigen::MatrixXd solve_pivoted_qr(const Eigen::MatrixXd& matrix,
                                               const Eigen::MatrixXd& right);

/// x of matrix x = right for a square matrix, by QR with column pivoting; nothing where its rank is
/// less than its size, to the tolerance of Eigen.
[[nodiscard]] std::optional<Eigen::VectorXd> solve_if_regular(const Eigen::MatrixXd& matrix,
                                                              const Eigen::VectorXd& right);

/// Orthonormal columns that span those of a matrix; pivots up to `threshold` of the largest count
/// as zero.
[[nodiscard]] Eigen::MatrixXd column_space(const Eigen::MatrixXd& matrix, double threshold);

/// All orthonormal columns Q of a QR decomposition, rows x rows: the last ones are orthogonal to
/// the columns of the matrix.
[[nodiscard]] Eigen::MatrixXd full_q(const Eigen::MatrixXd& matrix);

/// matrix = q r with as many columns in q as the matrix has; no more than it has rows.
struct ThinQr {
  Eigen::MatrixXd q;
  Eigen::MatrixXd r;
};
[[nodiscard]] ThinQr thin_qr(const Eigen::MatrixXd& matrix);

/// Least-squares solution with the factors of a matrix of full rank.
[[nodiscard]] Eigen::VectorXd solve_qr(const Eigen::HouseholderQR<Eigen::MatrixXd>& factors,
                                       const Eigen::VectorXd& right);

/// Q v and Q^T v for all columns Q of a QR decomposition.
[[nodiscard]] Eigen::VectorXd q_times(const Eigen::HouseholderQR<Eigen::MatrixXd>& factors,
                                      const Eigen::VectorXd& v);
[[nodiscard]] Eigen::VectorXd q_transposed_times(
    const Eigen::HouseholderQR<Eigen::MatrixXd>& factors, const Eigen::VectorXd& v);

}  // namespace rondure::core
