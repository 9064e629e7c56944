#pragma once

#include <cstddef>
#include <optional>

#include "core/result.h"
#include "evaluation/results/stated_value.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Value of one characteristic from an analysis.
struct AnalysisValue {
  double value_mm = 0.0;
  std::optional<double> limit_mm;  ///< In place of the tolerance: the line of a mask.
  int harmonic = 0;                ///< Of a mask: the order of the amplitude that is judged.
  std::size_t part = 0;            ///< Of a mask of several parts: which of them.
  core::Phrase detail;             ///< Joins the reason, e.g. "harmonic 5".
  std::optional<core::Phrase> void_because;  ///< Why the value proves nothing.
  /// With `void_because`: the true value is not below `value_mm`, so that above the tolerance it
  /// does prove something.
  bool lower_bound = false;
  /// What the true value may be above `value_mm` by what was not seen; no part of an interval.
  double unseen_mm = 0.0;
};

}  // namespace rondure::evaluation
