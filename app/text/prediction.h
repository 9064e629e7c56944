#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/prediction/prediction.h"
#include "app/prediction/sampling_search.h"

namespace rondure::app {

/// Predicted intervals: a table of at most 80 columns, and a list of characteristics as JSON (keys
/// with their units: docs/planning.md).
[[nodiscard]] std::string prediction_table(const plans::Plan& plan,
                                           const std::vector<PredictedCharacteristic>& predicted);
[[nodiscard]] nlohmann::ordered_json prediction_json(
    const plans::Plan& plan, const std::vector<PredictedCharacteristic>& predicted);

/// The samplings tried for a target U, and the changes for the plan: a table, and a list of
/// features as JSON.
[[nodiscard]] std::string search_table(const plans::Plan& plan,
                                       const std::vector<SamplingSearch>& searches,
                                       double target_mm);
[[nodiscard]] nlohmann::ordered_json search_json(const plans::Plan& plan,
                                                 const std::vector<SamplingSearch>& searches,
                                                 double target_mm);

}  // namespace rondure::app
