#pragma once

#include "plans/forecast/forecast.h"
#include "plans/plan.h"
#include "record/run_record.h"

namespace rondure::plans {

/// The record that a run would leave if part, fixture and probe were as the plan says: settings,
/// features, and the touches of the final clouds with their repeats, places and times. No touch has
/// an error, the part is at 20 degC; touches that enter no result (qualification, location, search)
/// and fields of the header that only a run knows are left out.
/// @param forecast  Of this plan.
[[nodiscard]] record::RunRecord expected_record(const Plan& plan, const Forecast& forecast);

}  // namespace rondure::plans
