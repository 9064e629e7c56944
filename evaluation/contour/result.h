#pragma once

#include <string>
#include <span>
#include <vector>

#include "evaluation/results/analysis_value.h"
#include "fit/contour/study.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// All results for a contour feature.
struct ContourResult {
  fit::ContourStudyOptions options;
  fit::ContourStudy study;
  std::vector<std::string> names;  ///< One name per part.
};

/// Evaluates feature `index` of a record.
/// @param result  Holds the feature; receives the warnings.
/// @return  The result, or the reason why there is none.
[[nodiscard]] core::Result<ContourResult> evaluate_contour(const record::RunRecord& record,
                                                           int index, FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const ContourResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of these values, in their order; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const ContourResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
[[nodiscard]] ValueOperator operator_of(const ContourResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const ContourResult& result);
[[nodiscard]] core::Phrase sampling_text(const ContourResult& result);

}  // namespace rondure::evaluation
