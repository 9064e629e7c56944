#pragma once

#include <cstdint>

#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/run_record.h"

// Converts a plan into the head of the journal, which is written before the first touch.

namespace rondure::plans {

[[nodiscard]] record::Strategy strategy_of(const FeaturePlan& feature);

/// The head of the record of a run: header, artefact, features and settings, as known before the
/// first touch. Omitted: descriptions of machine and fixture, digests of points files, the
/// calibration of the fixture.
/// @param seed  Seed of the simulation; stored when anything is simulated.
[[nodiscard]] record::RunRecord run_head(const Plan& plan, const RunOptions& options,
                                         std::uint64_t seed);

}  // namespace rondure::plans
