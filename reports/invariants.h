#pragma once

#include "core/result.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// Relations that hold for any data: MZ <= LS, no section wider than the zone of the cylinder, and
/// the witness of every cylinder's zone, checked by a routine that shares no code with the solver.
/// @return kInternal, naming the relation, the numbers and the feature.
[[nodiscard]] core::Result<void> check_invariants(const FeatureResult& result);

}  // namespace rondure::reports
