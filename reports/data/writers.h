#pragma once

#include <string>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/data/corrections.h"

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

/// report.dmo: actual features and tolerances as a DMIS (ISO 22093) output block. ASCII, mm.
[[nodiscard]] std::string write_dmis(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation);

/// report.json: every number of the evaluation, in um and deg where the key says so; keys in their
/// published order (docs/report.md); numbers in the shortest form that reads back to the same
/// double, null where they are not finite.
/// @param corrections  What each feature hands on to machines; empty: no entry names any.
[[nodiscard]] std::string write_json(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation,
                                     const std::vector<FeatureCorrections>& corrections = {});

}  // namespace rondure::reports
