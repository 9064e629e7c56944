#pragma once

#include "core/result.h"
#include "fit/probe_tip.h"
#include "plans/inspection.h"

namespace rondure::plans {

/// Touches the reference sphere, journals the touches, and checks the effective tip radius and the
/// probing form against the limits of the plan.
/// @return kCalibration with value and limit when the probe is not fit for measuring.
[[nodiscard]] core::Result<fit::ProbeTip> qualify_probe(RunContext& context);

}  // namespace rondure::plans
