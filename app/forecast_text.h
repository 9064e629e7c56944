#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "plans/forecast.h"

namespace rondure::app {

/// A forecast for a person: one line a stage, at most 80 columns.
[[nodiscard]] std::string forecast_table(const plans::Plan& plan, const plans::Forecast& forecast);
/// The same as JSON (keys with their units), one line feed at the end.
[[nodiscard]] std::string forecast_json(const plans::Plan& plan, const plans::Forecast& forecast);
/// Why there is no forecast, as JSON: {"problems": [{"code", "where", "what"}]}.
[[nodiscard]] std::string problems_json(const std::vector<core::Error>& problems);

}  // namespace rondure::app
