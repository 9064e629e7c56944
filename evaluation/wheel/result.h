#pragma once

#include <vector>

#include <Eigen/Core>

#include "evaluation/analysis_value.h"
#include "fit/wheel/evaluation.h"

namespace rondure::evaluation {

/// Everything found of a wheel feature, with what was asked for.
struct WheelResult {
  std::vector<Eigen::Vector2d> points_mm;  ///< As recorded, x and z.
  fit::WheelTask task;
  fit::WheelEvaluation evaluation;
};

[[nodiscard]] core::Result<AnalysisValue> value_of(const WheelResult& result,
                                                   const record::Characteristic& characteristic);
[[nodiscard]] ValueOperator operator_of(const WheelResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const WheelResult& result);
[[nodiscard]] core::Phrase sampling_text(const WheelResult& result);

}  // namespace rondure::evaluation
