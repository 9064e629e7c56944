#pragma once

#include <string>
#include <vector>

#include "evaluation/analysis_value.h"
#include "fit/contour/study.h"

namespace rondure::evaluation {

/// Everything found of a contour feature.
struct ContourResult {
  fit::ContourStudyOptions options;
  fit::ContourStudy study;
  std::vector<std::string> names;  ///< One a part.
};

[[nodiscard]] core::Result<AnalysisValue> value_of(const ContourResult& result,
                                                   const record::Characteristic& characteristic);
[[nodiscard]] ValueOperator operator_of(const ContourResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const ContourResult& result);
[[nodiscard]] core::Phrase sampling_text(const ContourResult& result);

}  // namespace rondure::evaluation
