#pragma once

#include <optional>
#include <string>

#include "core/result.h"
#include "evaluation/results/stated_value.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Value of one characteristic from an analysis.
struct AnalysisValue {
  double value_mm = 0.0;
  std::optional<double> limit_mm;           ///< Replaces the tolerance: the line of a mask.
  std::string detail;                       ///< Appended to the reason, e.g. "harmonic 5".
  std::optional<std::string> void_because;  ///< Why the value proves nothing; none if it does.
  /// With `void_because`: the true value is not below `value_mm`, so that a value above the
  /// tolerance still proves nonconformance.
  bool lower_bound = false;
};

}  // namespace rondure::evaluation
