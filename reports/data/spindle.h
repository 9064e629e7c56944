#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/spindle/result.h"

namespace rondure::reports {

/// A separation as JSON, as report.json and `rondure fit spindle --json` have it.
[[nodiscard]] nlohmann::ordered_json separation_json(const evaluation::SpindleResult& facts);

}  // namespace rondure::reports
