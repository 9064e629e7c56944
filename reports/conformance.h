#pragma once

#include <vector>

#include "record/run_record.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// Fills the characteristics of an evaluated feature: value, operator, verdict and its reason,
/// under the rule `simple acceptance`: conforms when the value is at most the tolerance; no
/// uncertainty is taken into account. Void when a condition is missing: no result, no certificate
/// behind a minimum zone, temperature outside the limits of the plan, or a run that did not finish.
void decide(const record::RunRecord& record, FeatureResult& result);

/// The worst verdict of all toleranced characteristics, in the order void, does not conform,
/// undecided, conforms; not toleranced when there is none.
[[nodiscard]] Verdict overall(const std::vector<FeatureResult>& features);

}  // namespace rondure::reports
