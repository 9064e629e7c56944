#pragma once

#include <optional>
#include <string>

#include "evaluation/results/evaluation.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// The uncertainty contributions that the plan declares (its settings "uncertainty/..."), completed
/// by values of the run itself: repeatability of a touch, tip qualification, temperatures.
struct Declared {
  Influences influences;
  UncertaintyOptions options;
  /// Terms of the form spectrum: none where no spectrum was asked for, empty for the part's own.
  std::optional<FormSpectrum> spectrum;
};

/// The declared contributions of the fixture; none when the plan declares none.
[[nodiscard]] std::optional<FixtureInfluences> fixture_influences(const record::RunRecord& record);

/// Settings of trials: those of the plan, or the defaults with the seed of the run.
[[nodiscard]] UncertaintyOptions uncertainty_options(const record::RunRecord& record);

/// None when the plan asks for no uncertainty.
[[nodiscard]] std::optional<Declared> declared_for(const record::RunRecord& record,
                                                   const FeatureResult& result,
                                                   const std::optional<fit::ProbeTip>& probe);

}  // namespace rondure::evaluation
