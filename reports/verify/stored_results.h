#pragma once

#include <vector>

#include "evaluation/results/evaluation.h"

namespace rondure::reports {

/// The numbers of an evaluation by their JSON pointer in report.json, for the journal's seal.
[[nodiscard]] std::vector<record::StoredResult> stored_results(
    const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
