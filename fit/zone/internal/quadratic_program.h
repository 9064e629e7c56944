#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace rondure::fit {

/// Minimum of a strictly convex quadratic function under linear limits.
struct QuadraticStep {
  Eigen::VectorXd x;
  std::vector<std::size_t> active;  ///< Rows that hold with equality and carry the minimum.
  std::vector<double> multipliers;  ///< Of the active rows, >= 0.
  bool solved = false;              ///< false: no x obeys all limits, or too many exchanges.
};

/// Minimises  x' H x / 2 + g' x  under  A x >= b  by the dual method of Goldfarb and Idnani: starts
/// at the free minimum, lets the limit enter that is violated most, and drops limits whose
/// multiplier would turn negative.
/// @param hessian    H, positive definite; at most some ten unknowns.
/// @param normals    A, one row for each limit.
/// @param tolerance  Violation that is round-off; > 0.
/// Cost: O(rows times unknowns) for each exchange, commonly 5 to 20.
/// Source: D. Goldfarb, A. Idnani, Mathematical Programming 27 (1983) 1-33.
[[nodiscard]] QuadraticStep solve_quadratic_program(const Eigen::MatrixXd& hessian,
                                                    const Eigen::VectorXd& gradient,
                                                    const Eigen::MatrixXd& normals,
                                                    const Eigen::VectorXd& limits,
                                                    double tolerance);

}  // namespace rondure::fit
