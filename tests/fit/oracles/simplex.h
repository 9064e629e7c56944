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

/// The textbook revised simplex method; every pivot solves the basis anew, so rounding errors do
/// not accumulate.
///
/// @param basis  Columns of a feasible basis, as many as rows.
/// @return  Multipliers of the rows at the optimum (also when 3000 pivots ended the search: check
///          them before use).
[[nodiscard]] LinearProgram::Vector multipliers(const LinearProgram& program,
                                                std::vector<Eigen::Index> basis);

}  // namespace rondure::test
