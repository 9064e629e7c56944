#pragma once

#include <optional>

#include <Eigen/Core>

namespace rondure::test {

/// The multipliers of a full set of contacts and how fast the zone grows away from the optimum.
struct Witness {
  Eigen::VectorXd weights;  ///< Outer contacts first; each side sums to 1.
  double growth = 0.0;      ///< sigma, per unit of the largest unknown.
};

/// Balances the gradients of contacts, as many as unknowns and sides together.
///
/// @param gradients  One column per contact, the outer ones first.
/// @param outer      Number of outer contacts; 0 or all leaves one side.
/// @return nothing where the contacts are degenerate or a multiplier is below `least`.
[[nodiscard]] std::optional<Witness> weigh(const Eigen::MatrixXd& gradients, Eigen::Index outer,
                                           double least = 0.03);

}  // namespace rondure::test
