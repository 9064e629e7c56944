#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// touches.csv: a row a touch, as journalled.
[[nodiscard]] std::string write_touches_csv(const record::RunRecord& record);

/// series.csv: a line a number: feature, series, row, column, value; hidden truth is left out.
[[nodiscard]] std::string write_series_csv(const record::RunRecord& record);

/// results.csv: a row a characteristic: value, tolerance, verdict, how it came about.
[[nodiscard]] std::string write_results_csv(const record::RunRecord& record,
                                            const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
