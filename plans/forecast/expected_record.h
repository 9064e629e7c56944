#pragma once

#include <cstdint>

#include "core/result.h"
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

/// Seed of the simulated readings of a forecast: another than that of the plan, whose run therefore
/// sees other noise.
[[nodiscard]] std::uint64_t forecast_seed(const Plan& plan);

/// The same record with the series of all analyses, simulated as in a run with `seed`, or read from
/// their files.
/// @return  The record; errors of files and tables name their place.
[[nodiscard]] core::Result<record::RunRecord> with_series(record::RunRecord expected,
                                                          const Plan& plan, std::uint64_t seed);

}  // namespace rondure::plans
