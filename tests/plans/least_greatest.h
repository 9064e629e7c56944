#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace rondure::plans {

/// Functions of the unknowns at one place, with their gradients as rows.
struct Functions {
  Eigen::VectorXd value;
  Eigen::MatrixXd gradient;
};

/// One group for each "greatest": their sum is minimised.
using Groups = std::function<std::vector<Functions>(const Eigen::VectorXd&)>;

/// The unknowns at which the sum over the groups of their greatest values is least: Newton on a
/// smooth upper bound that closes in on it. It shares nothing with the searches of the evaluation.
/// @return Nothing unless the sum is within 1e-9 mm of what its last step expects.
[[nodiscard]] std::optional<Eigen::VectorXd> least_greatest(const Groups& groups,
                                                            Eigen::VectorXd start);

}  // namespace rondure::plans
