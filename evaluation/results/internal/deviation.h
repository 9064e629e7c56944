#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "fit/zone/deviation_range.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// A form deviation of an evaluated feature, with its evidence.
struct Deviation {
  double value_mm = 0.0;
  /// Where the reference is not unique: range of the deviation over all equally good circles.
  /// `value_mm` is about one of them.
  std::optional<fit::DeviationRange> range;
  bool certified = true;   ///< The reference has a certificate; least squares needs none.
  bool exact_fit = false;  ///< The deviation is 0 by construction.
  const LayerResult* layer = nullptr;  ///< RONt: the section that gave the value.
  double unseen_rad = 0.0;             ///< See unseen_rad().
};

/// Largest angle without a point, where it is too wide for a value: above 90 deg, and above one and
/// a half steps of evenly spread points. Otherwise 0.
/// @param angles_rad  Within one turn.
/// @param a_turn      Number of points on one turn if they were evenly spread.
[[nodiscard]] double unseen_rad(std::vector<double> angles_rad, std::size_t a_turn);
/// Why such points have no verdict.
[[nodiscard]] core::Phrase unseen_words(double unseen_rad);

/// CYLt about a reference; or why that reference does not exist.
[[nodiscard]] core::Result<Deviation> cylinder_deviation(const FeatureResult& result,
                                                         record::Reference reference);

/// RONt of one section about a reference; or why that reference does not exist.
[[nodiscard]] core::Result<Deviation> section_deviation(const LayerResult& layer,
                                                        record::Reference reference);

/// RONt about a reference: the largest of the sections; fails if one section lacks the reference.
[[nodiscard]] core::Result<Deviation> worst_section(const FeatureResult& result,
                                                    record::Reference reference);

/// The end of a range that a verdict may be based on: the greatest, or the least where even that is
/// above the limit. No other choice of circle changes the verdict; where one would,
/// undecided_range() says so.
[[nodiscard]] double deciding_mm(const fit::DeviationRange& range,
                                 const std::optional<double>& limit_mm);

/// Why a range has no verdict: the limit lies in it. Nothing when it does not.
[[nodiscard]] std::optional<core::Phrase> undecided_range(const fit::DeviationRange& range,
                                                          const std::optional<double>& limit_mm);

}  // namespace rondure::evaluation
