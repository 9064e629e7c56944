#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/result.h"
#include "core/words.h"
#include "evaluation/factors/points.h"
#include "evaluation/factors/shares.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

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

  [[nodiscard]] const FactorCell& cell(const std::array<std::size_t, 4>& levels_of) const;
  /// The cell that differs from the reported one in one factor.
  [[nodiscard]] const FactorCell& changed(Factor factor, std::size_t level) const;
};

/// Evaluates a characteristic under every combination of reference (LS, MZ, MC, MI), filter
/// (unfiltered, Gaussian 15, 50, 150 UPR section by section, and that of the report), outlier rule
/// and sampling subset. Takes cylindricity and roundness of surfaces, and the roundness of a wheel
/// and of the part on a spindle.
///
/// The steps follow each other as in points.h and internal/outliers.h. The reported combination
/// carries the reported value, which is certified; the other values are proven locally. A
/// combination that cannot be evaluated states the reason.
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
