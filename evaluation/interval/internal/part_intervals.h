#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "evaluation/decision/decision.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/finding.h"
#include "evaluation/results/stated_value.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

/// A characteristic that find() computed.
struct PartQuestion {
  std::size_t feature = 0;  ///< Toleranced.
  const record::Characteristic* asked = nullptr;
  const Finding* found = nullptr;  ///< As read.
};

/// The uncertainties of the judged values of a characteristic.
struct PartInterval {
  std::vector<UncertaintyStatus> judged;     ///< In the order of Finding::judged.
  std::vector<std::vector<double>> rows_mm;  ///< All judged values, one row for each trial.
  /// Share of the trials with every judged value within its limits; none without trials, or where
  /// a value as read is missing. The probability that an envelope requirement is met.
  std::optional<double> conformance_1;
};

/// The judged values of a finding; all NaN where it has not as many as expected.
[[nodiscard]] std::vector<double> judged_values(const core::Result<Finding>& found,
                                                std::size_t count);

/// The uncertainties of all characteristics of a part, from trials that move the points of all its
/// features together. Pure; the record holds the seed.
/// @param features  All features of the run, in its order.
/// @param trials    In place of the settings that the plan declares.
/// @return  One for each question.
[[nodiscard]] std::vector<PartInterval> intervals_of(
    const record::RunRecord& record, std::span<const FeatureResult> features,
    const std::optional<fit::ProbeTip>& probe, std::span<const PartQuestion> questions,
    const std::optional<UncertaintyOptions>& trials = std::nullopt);

}  // namespace rondure::evaluation
