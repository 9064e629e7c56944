#pragma once

#include <vector>

#include "core/result.h"
#include "fit/probe_tip.h"
#include "plans/inspection.h"

namespace rondure::plans {

/// How the reference sphere is touched: from park height down to its pole, then around it.
/// kSampling when the plan asks for too few or too many touches.
[[nodiscard]] core::Result<std::vector<TouchStep>> qualification_steps(const Plan& plan);

/// Touches the reference sphere, journals the touches, and checks the effective tip radius and the
/// probing form against the limits of the plan.
/// @return kCalibration with value and limit when the probe is not fit for measuring.
[[nodiscard]] core::Result<fit::ProbeTip> qualify_probe(RunContext& context);

}  // namespace rondure::plans
