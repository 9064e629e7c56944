#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "fit/profiles/roundness_evaluation.h"

namespace rondure::app {

/// A roundness evaluation as JSON (keys with their units).
/// @param polar  The input was theta_deg,r_um: centres are offsets, radii a level.
[[nodiscard]] nlohmann::ordered_json roundness_json(const fit::RoundnessEvaluation& evaluation,
                                                    bool polar);
/// A roundness evaluation as a table.
[[nodiscard]] std::string roundness_table(const fit::RoundnessEvaluation& evaluation, bool polar);

}  // namespace rondure::app
