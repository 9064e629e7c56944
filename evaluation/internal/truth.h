#pragma once

#include <optional>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The record that the same run of a simulation would have made without errors of machine, probe,
/// fixture and temperature: the same touches, where they truly met the part, and no declared
/// uncertainty. Its values are what those of the run are held against.
/// @return Nothing where the record holds no hidden truth.
[[nodiscard]] std::optional<record::RunRecord> without_errors(const record::RunRecord& measured);

/// Writes the values of a record without errors beside those of the run. A feature whose hidden
/// truth is not on record, or one with a datum of that kind, gets none.
void keep_truths(const record::RunRecord& measured, const Evaluation& truth, Evaluation& out);

}  // namespace rondure::evaluation
