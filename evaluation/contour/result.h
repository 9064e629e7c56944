#pragma once

#include <string>
#include <vector>

#include "evaluation/results/analysis_value.h"
#include "fit/contour/study.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// Everything found of a contour feature.
struct ContourResult {
  fit::ContourStudyOptions options;
  fit::ContourStudy study;
  std::vector<std::string> names;  ///< One a part.
};

/// Evaluates feature `index` of a record.
/// @param result  With the feature; gets the warnings.
/// @return  Why there is no result, where there is none.
[[nodiscard]] core::Result<ContourResult> evaluate_contour(const record::RunRecord& record,
                                                           int index, FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const ContourResult& result,
                                                   const record::Characteristic& characteristic);
[[nodiscard]] ValueOperator operator_of(const ContourResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const ContourResult& result);
[[nodiscard]] core::Phrase sampling_text(const ContourResult& result);

}  // namespace rondure::evaluation
