#pragma once

#include <optional>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "fit/zone/deviation_range.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// A form deviation of an evaluated feature, and what stands behind it.
struct Deviation {
  double value_mm = 0.0;
  /// Where the reference is not unique: about which circles as good as each other the deviation may
  /// be taken. `value_mm` is about one of them.
  std::optional<fit::DeviationRange> range;
  bool certified = true;   ///< A certificate stands behind the reference; least squares needs none.
  bool exact_fit = false;  ///< 0 by construction.
  const LayerResult* layer = nullptr;  ///< RONt: the section it is of.
  /// Widest part of the turn without a point, where it is too wide for a value: above 90 deg, and
  /// above one and a half steps of evenly spread points. Else 0.
  double unseen_rad = 0.0;
};

/// CYLt about a reference. Without that reference: why there is none.
[[nodiscard]] core::Result<Deviation> cylinder_deviation(const FeatureResult& result,
                                                         record::Reference reference);

/// RONt about a reference, the largest of the sections; one that lacks the reference leaves none.
[[nodiscard]] core::Result<Deviation> worst_section(const FeatureResult& result,
                                                    record::Reference reference);

/// The end of a range that a verdict may rest on: the greatest, or the least where even that is
/// above the limit. No choice of circle then changes the verdict, or undecided_range() says so.
[[nodiscard]] double deciding_mm(const fit::DeviationRange& range,
                                 const std::optional<double>& limit_mm);

/// Why a range has no verdict: the limit lies in it. Nothing when it does not.
[[nodiscard]] std::optional<core::Phrase> undecided_range(const fit::DeviationRange& range,
                                                          const std::optional<double>& limit_mm);

}  // namespace rondure::evaluation
