#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Evaluates a record: averages repeated touches of one place in the final pose, fits, checks the
/// invariants, decides. Uses no machine, clock or files; the same record gives the same bits.
///
/// @return Always an evaluation: every fault of the data is stated in its feature, and so is a
///         violated invariant (a defect of the program: no value, all characteristics void;
///         evaluate_run() of defect.h keeps its numbers).
[[nodiscard]] core::Result<Evaluation> evaluate(const record::RunRecord& record);

/// A feature as a report draws it: fits, sections and deviations of the points that no window of
/// its characteristics names. Nothing where there is no window, or where the rest has no fit.
/// @param index  Of the feature in the record.
[[nodiscard]] std::optional<FeatureResult> outside_windows(const record::RunRecord& record,
                                                           int index, const FeatureResult& feature);
/// Rows of the cloud that a window names, ascending.
[[nodiscard]] std::vector<std::size_t> windowed_rows(const FeatureResult& feature);

}  // namespace rondure::evaluation
