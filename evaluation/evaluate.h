#pragma once

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Evaluates a record: averages repeated touches of one place in the final pose, fits, checks the
/// invariants, decides. No machine, no clock, no files; same record, same bits.
///
/// @return Always an evaluation: every fault of the data stands in the feature, and so does a
///         broken invariant (a defect of the program; no value, all void; evaluate_run() of
///         defect.h keeps its numbers).
[[nodiscard]] core::Result<Evaluation> evaluate(const record::RunRecord& record);

}  // namespace rondure::evaluation
