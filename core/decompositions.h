#pragma once

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
extern template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
extern template LDLT<Matrix<double, 6, 6>>& LDLT<Matrix<double, 6, 6>>::compute(
    const EigenBase<Matrix<double, 6, 6>>&);
extern template void ColPivHouseholderQR<MatrixXd>::computeInPlace();
extern template void HouseholderQR<MatrixXd>::computeInPlace();

}  // namespace Eigen
