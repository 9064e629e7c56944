#pragma once

#include <nlohmann/json.hpp>

#include "fit/wheel/evaluation.h"

namespace rondure::reports {

/// A wheel evaluation with its settings and limits: the JSON of `rondure fit wheel` and of
/// report.json (docs/wheel.md). A number that is not finite stands as null. Deviations, path and
/// residual form stand under "curves", a list a column.
[[nodiscard]] nlohmann::ordered_json wheel_json(const fit::WheelEvaluation& evaluation,
                                                const fit::WheelTask& task);

}  // namespace rondure::reports
