#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// touches.csv: one row for each touch, as journalled.
[[nodiscard]] std::string write_touches_csv(const record::RunRecord& record);

/// series.csv: one line for each number: feature, series, row, column, value; without hidden truth.
[[nodiscard]] std::string write_series_csv(const record::RunRecord& record);

/// results.csv: one row for each characteristic: value, tolerance, verdict, operator.
[[nodiscard]] std::string write_results_csv(const record::RunRecord& record,
                                            const evaluation::Evaluation& evaluation);

/// sections.csv: one row for each section, generatrix or circle of a characteristic.
[[nodiscard]] std::string write_sections_csv(const record::RunRecord& record,
                                             const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
