#pragma once

#include <optional>

#include "evaluation/results/gate.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The gate "stale-input" of a feature whose data come from a file: their age at the start of the
/// run against the days for which the plan lets them stand. None where the plan does not say when
/// they were measured.
[[nodiscard]] std::optional<Gate> age_gate(const record::RunRecord& record,
                                           const record::Feature& feature);

/// Why the data of a feature are too old to be judged; none where they are not.
[[nodiscard]] std::optional<core::Phrase> age_fault(const record::RunRecord& record,
                                                    const record::Feature& feature);

}  // namespace rondure::evaluation
