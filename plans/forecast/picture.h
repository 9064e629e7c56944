#pragma once

#include <string>

#include "plans/forecast/forecast.h"

namespace rondure::plans {

/// Draws the path of the tip in a stage of a forecast as SVG: from the side (machine x to the
/// right, z up) and from above (x to the right, y up), at one scale, with part, clamping ring, rim,
/// table, reference sphere, bodies, path, touches and a scale bar in mm. Plain text without scripts
/// or other files.
[[nodiscard]] std::string forecast_picture(const Plan& plan, const ForecastStage& stage);

}  // namespace rondure::plans
