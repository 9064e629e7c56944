#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/result.h"
#include "evaluation/interval/internal/declared.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/stated_value.h"
#include "evaluation/uncertainty/uncertainty.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// Input of the uncertainty engine for one characteristic.
struct UncertaintyQuestion {
  FormCloud cloud;
  Influences influences;
  std::optional<FormSpectrum> spectrum;
  UncertaintyOptions options;
};

/// The declared spectrum on a cloud, or an empty one where the part's own was asked for; none where
/// no spectrum was asked for.
[[nodiscard]] core::Result<std::optional<FormSpectrum>> spectrum_on(const FormCloud& cloud,
                                                                    const Declared& declared);

/// Why no interval is predicted of a feature, or computed by the trials of the part, whatever its
/// touches say; nothing where one is.
[[nodiscard]] std::optional<core::Phrase> why_no_interval(const record::RunRecord& record,
                                                          const record::Feature& feature);

/// Why no interval is computed of so many points; nothing where one is.
[[nodiscard]] std::optional<core::Phrase> too_many_points(std::size_t points);

/// The question behind uncertainty_of(), or why there is none: one sentence.
[[nodiscard]] tl::expected<UncertaintyQuestion, core::Phrase> uncertainty_question(
    const record::RunRecord& record, const FeatureResult& result,
    const std::optional<fit::ProbeTip>& probe, const record::Characteristic& asked);

/// The uncertainty of a form value of touches or points, from the engine of uncertainty.h on its
/// cloud, or why there is no interval. The roundness of several layers is that of the worst one.
/// Pure; the record holds the seed.
[[nodiscard]] UncertaintyStatus uncertainty_of(const record::RunRecord& record,
                                               const FeatureResult& result,
                                               const std::optional<fit::ProbeTip>& probe,
                                               const record::Characteristic& asked);

}  // namespace rondure::evaluation
