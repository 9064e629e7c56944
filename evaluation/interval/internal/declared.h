#pragma once

#include <optional>
#include <string>

#include "evaluation/results/evaluation.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// What the plan declared about a measurement, as its settings "uncertainty/..." keep it, completed
/// by what the run itself says: repeatability of a touch, tip qualification, temperatures.
struct Declared {
  Influences influences;
  UncertaintyOptions options;
  /// Terms of the form spectrum: nothing where none was asked for, empty for the part's own.
  std::optional<FormSpectrum> spectrum;
};

/// What the plan declared about the fixture; nothing when it did not.
[[nodiscard]] std::optional<FixtureInfluences> fixture_influences(const record::RunRecord& record);

/// Nothing when the plan asked for no uncertainty.
[[nodiscard]] std::optional<Declared> declared_for(const record::RunRecord& record,
                                                   const FeatureResult& result,
                                                   const std::optional<fit::ProbeTip>& probe);

}  // namespace rondure::evaluation
