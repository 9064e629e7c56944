#pragma once

#include <string>

#include "plans/forecast/forecast.h"

namespace rondure::plans {

/// The way of the tip in a stage of a forecast as SVG: seen from the side (machine x to the right,
/// z up) and from above (x to the right, y up), one scale, with part, clamping ring, rim, table,
/// reference sphere, path, touches and a scale bar in mm. Plain text, no script, no other file.
[[nodiscard]] std::string forecast_picture(const Plan& plan, const ForecastStage& stage);

}  // namespace rondure::plans
