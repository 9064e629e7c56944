#pragma once

#include "plans/forecast/forecast.h"
#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// The record of a run whose part, fixture and probe are as stated in the plan: settings, features,
/// and the touches of the final clouds with their repeats, positions and times. The touches have no
/// errors, and the part is at 20 degC. Omitted are touches that enter no result (qualification,
/// location, search) and header fields known only to a run.
/// @param forecast  Forecast of this plan.
[[nodiscard]] record::RunRecord expected_record(const Plan& plan, const Forecast& forecast);

}  // namespace rondure::plans
