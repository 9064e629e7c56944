#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/uncertainty/statement.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Predicted statement of a run about a characteristic of an analysis of series.
struct AnalysisPrediction {
  /// Why nothing is predicted; the members below are then empty. Empty if something is.
  std::string why;
  double coverage_1 = 0.0;
  double as_read_mm = 0.0;   ///< The value as read of the simulated data.
  double expected_mm = 0.0;  ///< Its estimate; with `at_most` the upper bound.
  double below_mm = 0.0;     ///< expected minus lower end [mm], >= 0.
  double above_mm = 0.0;     ///< upper end minus expected [mm], >= 0.
  bool at_most = false;      ///< Only the upper bound would be stated: noise dominates.
  /// By linear propagation: root sum of squares of the budget [mm].
  double linear_u_mm = 0.0;
  std::vector<BudgetLine> budget;  ///< Linear propagation; ranked, the largest first.

  /// U: half the width of the interval.
  [[nodiscard]] double expanded_mm() const { return 0.5 * (below_mm + above_mm); }
};

/// Why the value of a characteristic cannot be foretold, whatever is declared: it is the scatter or
/// the error of what is measured, which only readings show. None of the others.
[[nodiscard]] std::optional<std::string> why_not_foretold(record::Form form);

/// Predicts the intervals of the characteristics of an analysis before its first reading, in their
/// order: evaluates one simulated set of data as a run does, with its declared influences.
///
/// @param simulated  A record that holds the simulated series of the feature.
/// @param feature    Index of a spindle, wheel or contour.
/// @return  kBadOption for another feature; `why` states what prevents an interval. Same input,
/// same
///          bits, on one kind of processor.
[[nodiscard]] core::Result<std::vector<AnalysisPrediction>> predict_analysis(
    const record::RunRecord& simulated, int feature);

}  // namespace rondure::evaluation
