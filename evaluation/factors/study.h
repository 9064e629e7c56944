#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "core/words.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

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

/// Choices that two programs may make differently for the same points, in the order of a
/// FactorTable.
enum class Factor : std::size_t { kReference, kFilter, kOutliers, kSampling };
inline constexpr std::array kFactors = {Factor::kReference, Factor::kFilter, Factor::kOutliers,
                                        Factor::kSampling};
/// Index of a factor in arrays by factor.
[[nodiscard]] constexpr std::size_t at(Factor factor) { return static_cast<std::size_t>(factor); }

RONDURE_WORDS(Factor, {kReference, "reference"}, {kFilter, "filter"}, {kOutliers, "outliers"},
              {kSampling, "sampling"});

/// The value of a characteristic under one choice of all factors.
struct FactorCell {
  std::optional<double> value_mm;
  std::string why;           ///< Why there is no value; empty with one.
  std::size_t points = 0;    ///< Number evaluated, before any resampling.
  std::size_t left_out = 0;  ///< Number removed by the outlier rule.
};

/// Effect of one factor while all others stay as reported.
struct FactorEffect {
  /// Least change over all levels that have a value, including the reported one (0).
  double least_change_mm = 0.0;
  double greatest_change_mm = 0.0;
  /// Level of the change farthest from 0; the reported level means no change.
  std::size_t strongest = 0;
  std::size_t levels = 0;  ///< Number of levels that have a value.

  [[nodiscard]] double range_mm() const { return greatest_change_mm - least_change_mm; }
};

/// A characteristic as other programs might have evaluated it, and the causes of the differences.
struct FactorStudy {
  std::string feature;
  record::Characteristic characteristic;
  std::string symbol;          ///< "CYLt"
  std::string value;           ///< Value as reported, with its interval: "8.31 um [7.60, 9.40]".
  std::string operator_words;  ///< "MZCY; unfiltered; ..."
  double reported_mm = 0.0;
  std::array<std::vector<std::string>, 4> levels;  ///< Names of the levels, by factor.
  std::array<std::size_t, 4> reported = {0, 0, 0, 0};
  std::vector<FactorCell> cells;  ///< Every combination; the sampling varies fastest.
  std::array<FactorEffect, 4> effects;
  std::optional<FactorShares> shares;  ///< None where nothing makes a difference.

  /// Index of a combination in `cells`.
  [[nodiscard]] std::size_t index(const std::array<std::size_t, 4>& levels_of) const;
  [[nodiscard]] const FactorCell& cell(const std::array<std::size_t, 4>& levels_of) const;
  /// The cell that differs from the reported one in one factor.
  [[nodiscard]] const FactorCell& changed(Factor factor, std::size_t level) const;
};

/// Asks find() for a characteristic under every combination of reference (LS, MZ, MC, MI), filter
/// (unfiltered, Gaussian 15, 50, 150 UPR section by section, and that of the report), outlier rule
/// (none; beyond 3 s of the least-squares feature; that of a plan) and sampling. Takes cylindricity
/// and roundness of surfaces, and the roundness of a wheel and of the part on a spindle.
///
/// Points are left out as another sampling plan would, then outliers, the rest filtered and fitted.
/// The rule of a plan has no value where what lies off is form. Windows, portion, parameter and
/// layers stay those of the plan. The reported combination carries the reported value, which is
/// certified; the other values are proven locally. A combination that cannot be evaluated states
/// the reason.
///
/// @return The failure of the feature; kMeaning with the reason for any other form;
///         kReferenceAbsent where the characteristic has no value.
/// Cost: docs/compare.md.
[[nodiscard]] core::Result<FactorStudy> study_factors(const FeatureResult& feature,
                                                      const CharacteristicResult& characteristic);

/// The studies of a run, and the characteristics that have none.
struct RunComparison {
  std::vector<FactorStudy> studies;
  std::vector<core::Error> without;  ///< `where`: "feature / characteristic".
};

/// Studies every characteristic of a run, in its order.
/// @return kNoPoints when no characteristic has a value.
[[nodiscard]] core::Result<RunComparison> compare_run(const Evaluation& evaluation);

/// One sentence: the value as reported, and how much each factor changes it.
[[nodiscard]] std::string answer_of(const FactorStudy& study);

}  // namespace rondure::evaluation
