#pragma once

#include <string>

#include "evaluation/factors/study.h"

namespace rondure::reports {

/// A comparison as text of at most 80 columns.
/// @param all  Also lists every combination that has a value.
[[nodiscard]] std::string comparison_text(const std::string& run_id,
                                          const evaluation::RunComparison& comparison, bool all);

}  // namespace rondure::reports
