#pragma once

#include <optional>

#include "fit/probe_tip.h"
#include "record/run_record.h"
#include "reports/evaluation.h"
#include "reports/uncertainty.h"

namespace rondure::reports {

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

/// The uncertainty of a form value of touches or points: the engine of uncertainty.h on the cloud
/// that gave it, or why there is no interval. Roundness of several layers is that of the worst one.
/// Pure; the seed stands in the record.
[[nodiscard]] UncertaintyStatus uncertainty_of(const record::RunRecord& record,
                                               const FeatureResult& result,
                                               const std::optional<fit::ProbeTip>& probe,
                                               const record::Characteristic& asked);

}  // namespace rondure::reports
