#pragma once

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Evaluates a record: averages repeated touches of one place in the final pose, fits, checks the
/// invariants, decides. Uses no machine, clock or files; the same record gives the same bits.
///
/// @return Always an evaluation: every fault of the data is stated in its feature, and so is a
///         violated invariant (a defect of the program: no value, all characteristics void;
///         evaluate_checked() of defect.h keeps its numbers).
[[nodiscard]] core::Result<Evaluation> evaluate(const record::RunRecord& record);

/// Evaluates feature `index`, which calibrates the fixture, when its last ball was touched, as
/// evaluate() does later: features after it take what it gives (rotary/result.h).
[[nodiscard]] FeatureResult evaluate_calibration(const record::RunRecord& so_far, int index);

}  // namespace rondure::evaluation
