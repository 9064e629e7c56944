#pragma once

#include <vector>

#include <Eigen/Core>

#include "evaluation/results/analysis_value.h"
#include "fit/wheel/evaluation.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// Everything found of a wheel feature, with what was asked for.
struct WheelResult {
  std::vector<Eigen::Vector2d> points_mm;  ///< As recorded, x and z.
  fit::WheelTask task;
  fit::WheelEvaluation evaluation;
};

/// Evaluates feature `index` of a record.
/// @param result  With the feature; gets the warnings.
/// @return  Why there is no result, where there is none.
[[nodiscard]] core::Result<WheelResult> evaluate_wheel(const record::RunRecord& record, int index,
                                                       FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const WheelResult& result,
                                                   const record::Characteristic& characteristic);
[[nodiscard]] ValueOperator operator_of(const WheelResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const WheelResult& result);
[[nodiscard]] core::Phrase sampling_text(const WheelResult& result);

}  // namespace rondure::evaluation
