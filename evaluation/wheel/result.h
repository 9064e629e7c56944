#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "evaluation/results/analysis_value.h"
#include "evaluation/results/gate.h"
#include "fit/wheel/evaluation.h"
#include "record/tasks/analysis_influences.h"

namespace rondure::evaluation {

struct FeatureResult;  // results/evaluation.h

/// All results for a wheel feature, with its settings.
struct WheelResult {
  std::vector<Eigen::Vector2d> points_mm;  ///< x and z as recorded.
  fit::WheelTask task;
  fit::WheelEvaluation evaluation;
  std::optional<record::WheelInfluencesTask> declared;  ///< As the plan declares them.
  /// Of the effective radius [mm]; none where it is not known.
  UncertaintyStatus effective_radius = UncertaintyStatus::none({});
};

/// Evaluates feature `index` of a record.
/// @param result  Holds the feature; receives the warnings.
/// @return  The result, or the reason why there is none.
[[nodiscard]] core::Result<WheelResult> evaluate_wheel(const record::RunRecord& record, int index,
                                                       FeatureResult& result);

[[nodiscard]] core::Result<AnalysisValue> value_of(const WheelResult& result,
                                                   const record::Characteristic& characteristic);
/// The intervals of these values, in their order; or why there is none.
[[nodiscard]] std::vector<UncertaintyStatus> intervals_of(
    const WheelResult& result, std::span<const record::Characteristic> characteristics,
    const UncertaintyOptions& options);
/// The interval of the effective radius.
[[nodiscard]] UncertaintyStatus effective_radius_interval(const WheelResult& result,
                                                          const UncertaintyOptions& options);
/// The gates of these characteristics, passed or not.
[[nodiscard]] std::vector<Gate> gates_of(const WheelResult& result,
                                         std::span<const record::Characteristic> characteristics);
[[nodiscard]] ValueOperator operator_of(const WheelResult& result,
                                        const record::Characteristic& characteristic,
                                        const core::Phrase& temperature);
[[nodiscard]] core::Phrase filter_text(const WheelResult& result);
[[nodiscard]] core::Phrase sampling_text(const WheelResult& result);

}  // namespace rondure::evaluation
