#pragma once

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
  evaluation::Prediction prediction;
};

/// Predicts all characteristics of a plan, in its order.
[[nodiscard]] core::Result<std::vector<PredictedCharacteristic>> predict_plan(
    const plans::Plan& plan, const plans::Forecast& forecast);

/// The largest influences in words: "probe-repeatability 61 %, machine-squareness 20 %".
/// @param measurand  The sampling is an influence of the whole surface only.
[[nodiscard]] std::string largest_influences(const evaluation::Prediction& prediction,
                                             evaluation::Measurand measurand);

}  // namespace rondure::app
