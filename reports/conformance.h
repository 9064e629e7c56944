#pragma once

#include <optional>
#include <vector>

#include "record/run_record.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// Fills the characteristics of an evaluated feature: value, operator, verdict and its reason,
/// under the rule `simple acceptance`: conforms when the value is at most the tolerance; no
/// uncertainty is taken into account. Void when a condition is missing: no result, a
/// reference that does not exist for the points, no certificate behind it, temperature outside the
/// limits of the plan, or a run that did not finish.
///
/// @param probe  The qualification of the run; a touched feature without a sound one is void.
void decide(const record::RunRecord& record, const std::optional<fit::ProbeTip>& probe,
            FeatureResult& result);

/// Void when a feature failed; else the worst verdict of all toleranced characteristics, in the
/// order void, does not conform, undecided, conforms; not toleranced when there is none.
[[nodiscard]] Verdict overall(const std::vector<FeatureResult>& features);

}  // namespace rondure::reports
