#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/error.h"
#include "plans/forecast/forecast.h"

namespace rondure::app {

/// "4:07" or "1:02:10".
[[nodiscard]] std::string clock_text(double time_s);

/// A line where nothing is known of what holds a part without a fixture; otherwise empty.
[[nodiscard]] std::string holder_line(const plans::Plan& plan);
/// A forecast as a table: one line per stage, at most 80 columns.
[[nodiscard]] std::string forecast_table(const plans::Plan& plan, const plans::Forecast& forecast);
/// A forecast as JSON (keys with their units), to which the predictions are added.
[[nodiscard]] nlohmann::ordered_json forecast_json(const plans::Plan& plan,
                                                   const plans::Forecast& forecast);
/// Why there is no forecast, as JSON: {"problems": [{"code", "where", "what"}]}.
[[nodiscard]] std::string problems_json(const std::vector<core::Error>& problems);

}  // namespace rondure::app
