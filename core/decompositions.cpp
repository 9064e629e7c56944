#include "core/decompositions.h"

namespace Eigen {

template SelfAdjointEigenSolver<Matrix2d>& SelfAdjointEigenSolver<Matrix2d>::compute(
    const EigenBase<Matrix2d>&, int);
template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
template SelfAdjointEigenSolver<Matrix4d>& SelfAdjointEigenSolver<Matrix4d>::compute(
    const EigenBase<Matrix4d>&, int);
template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
template LDLT<Matrix3d>& LDLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
template LDLT<Matrix4d>& LDLT<Matrix4d>::compute(const EigenBase<Matrix4d>&);
template LDLT<Matrix<double, 5, 5>>& LDLT<Matrix<double, 5, 5>>::compute(
    const EigenBase<Matrix<double, 5, 5>>&);
template LDLT<Matrix<double, 6, 6>>& LDLT<Matrix<double, 6, 6>>::compute(
    const EigenBase<Matrix<double, 6, 6>>&);
template void ColPivHouseholderQR<MatrixXd>::computeInPlace();
template void HouseholderQR<MatrixXd>::computeInPlace();

}  // namespace Eigen
