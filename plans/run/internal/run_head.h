#pragma once

#include <cstdint>

#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/run_record.h"

// Converts a plan into the head of the journal, which is written before the first touch.

namespace rondure::plans {

[[nodiscard]] record::Strategy strategy_of(const FeaturePlan& feature);
/// Converts a feature, without the digest of its points file, which is not read here.
[[nodiscard]] record::Feature feature_of(const FeaturePlan& plan);
/// Sampling and temperature correction of a touched feature, as needed by the evaluation.
[[nodiscard]] std::vector<record::Setting> settings_of(const Plan& plan,
                                                       const FeaturePlan& feature);
/// Settings of the whole run: the decision rule and the declared uncertainty, by their keys.
[[nodiscard]] std::vector<record::Setting> settings_of(const Plan& plan);
/// The head without the descriptions of machine and fixture.
/// @param seed  Of the simulation; stored when anything is simulated.
[[nodiscard]] record::Header header_of(const Plan& plan, const RunOptions& options,
                                       std::uint64_t seed);
/// The reference sphere; empty for a plan without a probe.
[[nodiscard]] record::Artefact artefact_of(const Plan& plan);

}  // namespace rondure::plans
