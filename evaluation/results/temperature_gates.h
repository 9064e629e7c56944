#pragma once

#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The gates "temperature" (the limits of the plan; what was neither measured nor declared voids)
/// and, of an analysis, "temperature-drift". They hold for all touched features, and for points of
/// files and series where the plan has the object `environment`; empty for others.
/// @param result  With its temperatures.
[[nodiscard]] std::vector<Gate> temperature_gates(const record::RunRecord& record,
                                                  const FeatureResult& result);

}  // namespace rondure::evaluation
