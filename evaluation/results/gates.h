#pragma once

#include <optional>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "evaluation/results/gate.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The gates "temperature" (the limits of the plan; what was neither measured nor declared voids)
/// and, of an analysis, "temperature-drift". They hold for all touched features, and for points of
/// files and series where the plan has the object `environment`; empty for others.
/// @param result  With its temperatures.
[[nodiscard]] std::vector<Gate> temperature_gates(const record::RunRecord& record,
                                                  const FeatureResult& result);

/// The gate "stale-input" of a feature whose data come from a file: their age at the start of the
/// run against the days for which the plan lets them stand. None where the plan does not say when
/// they were measured.
[[nodiscard]] std::optional<Gate> age_gate(const record::RunRecord& record,
                                           const record::Feature& feature);

/// Why the data of a feature are too old to be judged; none where they are not.
[[nodiscard]] std::optional<core::Phrase> age_fault(const record::RunRecord& record,
                                                    const record::Feature& feature);

}  // namespace rondure::evaluation
