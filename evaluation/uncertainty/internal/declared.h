#pragma once

#include <optional>
#include <string>

#include "evaluation/evaluation.h"
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

/// Nothing when the plan asked for no uncertainty, or its settings do not say what a plan says:
/// why_no_interval().
[[nodiscard]] std::optional<Declared> declared_for(const record::RunRecord& record,
                                                   const FeatureResult& result,
                                                   const std::optional<fit::ProbeTip>& probe);

/// What the engine of uncertainty.h is asked about a characteristic.
struct UncertaintyQuestion {
  FormCloud cloud;
  Influences influences;
  std::optional<FormSpectrum> spectrum;
  UncertaintyOptions options;
};

/// All points of a cylinder or a circle, as the engine takes them.
/// @return  The errors of form_cloud().
[[nodiscard]] core::Result<FormCloud> surface_cloud(const FeatureResult& result);

/// The declared spectrum on a cloud, or none of its own terms where the part's own was asked for;
/// nothing where nobody asked.
[[nodiscard]] core::Result<std::optional<FormSpectrum>> spectrum_on(const FormCloud& cloud,
                                                                    const Declared& declared);

/// Why no interval is computed of a feature, whatever its touches say; nothing where one is.
[[nodiscard]] std::optional<std::string> why_no_interval(const record::RunRecord& record,
                                                         const record::Feature& feature);

/// The question behind uncertainty_of(), or why there is none: one sentence.
[[nodiscard]] tl::expected<UncertaintyQuestion, std::string> uncertainty_question(
    const record::RunRecord& record, const FeatureResult& result,
    const std::optional<fit::ProbeTip>& probe, const record::Characteristic& asked);

/// The uncertainty of a form value of touches or points: the engine of uncertainty.h on the cloud
/// that gave it, or why there is no interval. Roundness of several layers is that of the worst one.
/// Pure; the seed stands in the record.
[[nodiscard]] UncertaintyStatus uncertainty_of(const record::RunRecord& record,
                                               const FeatureResult& result,
                                               const std::optional<fit::ProbeTip>& probe,
                                               const record::Characteristic& asked);

}  // namespace rondure::evaluation
