#pragma once

#include <string>

#include "evaluation/factors/study.h"

namespace rondure::reports {
/// A comparison as JSON (docs/compare.md), always with every combination; a line feed at the end.
[[nodiscard]] std::string comparison_json(const std::string& run_id,
                                          const evaluation::RunComparison& comparison);

}  // namespace rondure::reports
