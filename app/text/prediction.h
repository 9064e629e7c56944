#pragma once

#include <string>
#include <vector>

#include "app/prediction/prediction.h"
#include "app/prediction/sampling_search.h"

namespace rondure::app {

/// Predicted intervals as a table, at most 80 columns.
[[nodiscard]] std::string prediction_table(const plans::Plan& plan,
                                           const std::vector<PredictedCharacteristic>& predicted);
/// The samplings tried for a target U, and the changes for the plan.
[[nodiscard]] std::string search_table(const plans::Plan& plan,
                                       const std::vector<SamplingSearch>& searches,
                                       double target_mm);

}  // namespace rondure::app
