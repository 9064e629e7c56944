#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/prediction/prediction.h"
#include "app/prediction/sampling_search.h"

namespace rondure::app {

/// The predictions of text/prediction.h as JSON: a list of characteristics, a list of features.
/// Keys with their units: docs/planning.md.
[[nodiscard]] nlohmann::ordered_json prediction_json(
    const plans::Plan& plan, const std::vector<PredictedCharacteristic>& predicted);
[[nodiscard]] nlohmann::ordered_json search_json(const plans::Plan& plan,
                                                 const std::vector<SamplingSearch>& searches,
                                                 double target_mm);

}  // namespace rondure::app
