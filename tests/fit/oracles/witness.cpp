#include "witness.h"

#include <Eigen/LU>

namespace rondure::test {

std::optional<Witness> weigh(const Eigen::MatrixXd& gradients, Eigen::Index outer, double least) {
  const Eigen::Index unknowns = gradients.rows();
  const Eigen::Index contacts = gradients.cols();
  const bool both = outer > 0 && outer < contacts;
  // Rows: a_h = H - J_h x and b_l = J_l x - G in the columns x, then H, then G.
  Eigen::MatrixXd slack = Eigen::MatrixXd::Zero(contacts, contacts);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(contacts);
  for (Eigen::Index i = 0; i < contacts; ++i) {
    const double sign = i < outer ? 1.0 : -1.0;
    slack.row(i).head(unknowns) = -sign * gradients.col(i).transpose();
    slack(i, unknowns + (both && i >= outer ? 1 : 0)) = sign;
  }
  if (outer > 0) sum(unknowns) = 1.0;
  if (outer < contacts) sum(contacts - 1) = -1.0;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(slack);
  if (!lu.isInvertible()) return std::nullopt;
  const Eigen::MatrixXd inverse = lu.inverse();
  Witness out;
  out.weights = inverse.transpose() * sum;
  if (out.weights.minCoeff() < least) return std::nullopt;
  // H - G = 1 is a simplex of slacks with the corners e_j / weight_j.
  const Eigen::MatrixXd corners =
      inverse.topRows(unknowns) * out.weights.cwiseInverse().asDiagonal();
  out.growth = 1.0 / corners.cwiseAbs().maxCoeff();
  return out;
}

}  // namespace rondure::test
