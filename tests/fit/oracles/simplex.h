#pragma once

#include <vector>

#include <Eigen/Core>

namespace rondure::test {

/// min cost.y  subject to  rows y = right, y >= 0, in long double.
struct LinearProgram {
  using Real = long double;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

  Matrix rows;
  Vector right;
  Vector cost;
};

/// The textbook revised simplex; the basis is solved anew in every pivot, so nothing accumulates.
///
/// @param basis  Columns of a feasible basis, as many as rows.
/// @return  Multipliers of the rows at the optimum (also when 3000 pivots ended it: check what you
///          do with them).
[[nodiscard]] LinearProgram::Vector multipliers(const LinearProgram& program,
                                                std::vector<Eigen::Index> basis);

}  // namespace rondure::test
