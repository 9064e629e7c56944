#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/spindle/result.h"

namespace rondure::reports {

/// A separation as report.json has it.
[[nodiscard]] nlohmann::ordered_json separation_json(const evaluation::SpindleResult& facts);

}  // namespace rondure::reports
