#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace rondure::evaluation {

/// A value for every combination of the levels of some factors; the last factor varies fastest.
struct FactorTable {
  std::vector<std::size_t> levels;  ///< Number of levels of each factor, >= 1.
  /// One per combination; none where the combination has no value.
  std::vector<std::optional<double>> values;

  /// Index of the value of a combination.
  [[nodiscard]] std::size_t index(std::span<const std::size_t> combination) const;
  /// The combination of the value at an index.
  [[nodiscard]] std::vector<std::size_t> combination(std::size_t index) const;
};

/// Share of each factor in the variance of a table, over a full block of it.
struct FactorShares {
  std::vector<std::vector<std::size_t>> used;  ///< Levels of each factor in the block, ascending.
  std::size_t values = 0;                      ///< Number of values in the block.
  double mean = 0.0;
  double variance = 0.0;        ///< Sum of squares in the block divided by `values`; > 0.
  std::vector<double> share_1;  ///< Main effect of each factor; 0 for one with a single level left.
  double together_1 = 0.0;      ///< The rest: factors that act on each other. All shares sum to 1.
};

/// Variance shares of a factorial table (analysis of variance, each level of a factor alike).
///
/// Missing values are not zeros. Where one is missing, levels are left out until every remaining
/// combination has a value: each time the level with the largest fraction of missing values (on a
/// tie that of the factor with the most levels, then the first), never a level of `reported`. In
/// that block, with N values y and mean m,
///   share of factor f = sum over its levels l of N/L_f (mean of l - m)^2 / sum (y - m)^2,
/// and the remainder after the main effects is the share of the factors together.
///
/// @param reported  The combination that is always kept; its value must exist.
/// @return Nothing when all values of the block are equal (to 1e-12 of their unit or of their
///         size). O(values x levels).
/// Source: D. C. Montgomery, "Design and Analysis of Experiments", chapter 5.
[[nodiscard]] std::optional<FactorShares> factor_shares(const FactorTable& table,
                                                        std::span<const std::size_t> reported);

}  // namespace rondure::evaluation
