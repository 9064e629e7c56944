#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/result.h"
#include "evaluation/decision/decision.h"
#include "evaluation/results/analysis_value.h"
#include "evaluation/results/evaluation.h"
#include "evaluation/results/stated_value.h"
#include "fit/least_squares/probe_tip.h"
#include "record/run_record.h"

namespace rondure::evaluation {

struct AnalysisResult;  // analysis_result.h

/// The value of a characteristic, or why there is none.
[[nodiscard]] core::Result<AnalysisValue> value_of(const AnalysisResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of the values that characteristics ask for, in their order, from one set of
/// trials; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const AnalysisResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
/// How the value came about: "LSCI; gaussian low pass 50 UPR; ...; 20.3 degC".
[[nodiscard]] ValueOperator operator_of(const AnalysisResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
/// The filter, and what was recorded, as the archive keeps them.
[[nodiscard]] core::Phrase filter_text(const AnalysisResult& result);
[[nodiscard]] core::Phrase sampling_text(const AnalysisResult& result);

/// Evaluates a feature whose shape is an analysis, by the file of its shape. Same record, same
/// bits.
/// @param probe  The qualification of the run, for an analysis of touches.
/// @param earlier  The features before it, evaluated and judged: it may take values of them.
[[nodiscard]] FeatureResult evaluate_analysis(const record::RunRecord& record, int index,
                                              const std::optional<fit::ProbeTip>& probe,
                                              std::span<const FeatureResult> earlier = {});

/// Fills the characteristics of an analysed feature and applies the rule to them. A characteristic
/// is void without a result or a value, with a value of a void feature, outside the temperature
/// limits, where the value proves nothing, when the run did not finish, or when its rule needs an
/// interval and there is none.
/// @param with_intervals  False where only the values are wanted.
void decide_analysis(const record::RunRecord& record, const core::Result<DecisionRule>& rule,
                     FeatureResult& result, bool with_intervals = true);

}  // namespace rondure::evaluation
