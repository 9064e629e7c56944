#include "simplex.h"

#include <limits>

#include <Eigen/LU>

namespace rondure::test {
namespace {

using Real = LinearProgram::Real;
using Vector = LinearProgram::Vector;
using Matrix = LinearProgram::Matrix;

/// Dantzig's rule; Bland's from pivot 300 on, which cannot cycle. -1: optimal.
Eigen::Index entering(const Vector& reduced, Real tolerance, int pivot) {
  Eigen::Index best = -1;
  Real least = -tolerance;
  for (Eigen::Index j = 0; j < reduced.size(); ++j) {
    if (reduced(j) >= least) continue;
    best = j;
    if (pivot >= 300) return best;
    least = reduced(j);
  }
  return best;
}

/// Place in the basis that reaches zero first; ties go to the lowest column. -1: unbounded.
Eigen::Index leaving(const Vector& values, const Vector& direction,
                     const std::vector<Eigen::Index>& basis) {
  Eigen::Index best = -1;
  Real least = std::numeric_limits<Real>::infinity();
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (direction(k) <= 1e-14L) continue;
    const Real ratio = (values(k) > 0.0L ? values(k) : 0.0L) / direction(k);
    const bool tie = best >= 0 && ratio == least &&
                     basis[static_cast<std::size_t>(k)] < basis[static_cast<std::size_t>(best)];
    if (ratio < least || tie) {
      best = k;
      least = ratio;
    }
  }
  return best;
}

}  // namespace

Vector multipliers(const LinearProgram& program, std::vector<Eigen::Index> basis) {
  const Eigen::Index m = program.right.size();
  const Real tolerance = 1e-17L * program.cost.cwiseAbs().maxCoeff();
  Matrix square(m, m);
  Vector cost(m);
  Vector pi(m);
  for (int pivot = 0; pivot < 3000; ++pivot) {
    for (Eigen::Index k = 0; k < m; ++k) {
      square.col(k) = program.rows.col(basis[static_cast<std::size_t>(k)]);
      cost(k) = program.cost(basis[static_cast<std::size_t>(k)]);
    }
    const Eigen::PartialPivLU<Matrix> lu(square);
    pi = lu.transpose().solve(cost);
    const Eigen::Index in =
        entering(program.cost - program.rows.transpose() * pi, tolerance, pivot);
    if (in < 0) break;
    const Eigen::Index out =
        leaving(lu.solve(program.right), lu.solve(program.rows.col(in)), basis);
    if (out < 0) break;
    basis[static_cast<std::size_t>(out)] = in;
  }
  return pi;
}

}  // namespace rondure::test
