#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/prediction/predict.h"
#include "plans/forecast/forecast.h"
#include "plans/plan.h"

namespace rondure::app {

/// The predicted result for one characteristic of a plan.
struct PredictedCharacteristic {
  std::size_t feature = 0;  ///< Index into the plan.
  record::Characteristic characteristic;
  /// Of a surface; of an analysis `why` alone, where nothing is predicted.
  evaluation::Prediction prediction;
  /// Of an analysis: what one simulated set of data with the seed `simulated_seed` gives.
  std::optional<evaluation::AnalysisPrediction> analysis = {};
  std::uint64_t simulated_seed = 0;

  /// Of the calibration of a fixture: the uncertainty of its value, which `prediction.why` says
  /// cannot be foretold.
  std::optional<evaluation::ResidualPrediction> residual = {};

  /// Whether the interval of a surface is predicted.
  [[nodiscard]] bool states_surface() const { return !analysis && prediction.why.empty(); }
};

/// Predicts all characteristics of a plan, in its order.
[[nodiscard]] core::Result<std::vector<PredictedCharacteristic>> predict_plan(
    const plans::Plan& plan, const plans::Forecast& forecast);

/// The largest lines of a budget in words: "point 61 %, axis 20 %".
[[nodiscard]] std::string largest_of(const std::vector<evaluation::BudgetLine>& budget);
/// The largest influences in words: "probe-repeatability 61 %, machine-squareness 20 %".
/// @param measurand  The sampling is an influence of the whole surface only.
[[nodiscard]] std::string largest_influences(const evaluation::Prediction& prediction,
                                             evaluation::Measurand measurand);

}  // namespace rondure::app
