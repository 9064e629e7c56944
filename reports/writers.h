#pragma once

#include <string>

#include "record/run_record.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// report.json: every number of the evaluation, in um and deg where the key says so; keys in a
/// fixed order; numbers in the shortest form that reads back to the same double.
[[nodiscard]] std::string write_json(const record::RunRecord& record, const Evaluation& evaluation);

/// report.html: one self-contained page (no network, no script needed to read it).
[[nodiscard]] std::string write_html(const record::RunRecord& record, const Evaluation& evaluation);

/// touches.csv: a row a touch, as journalled.
[[nodiscard]] std::string write_touches_csv(const record::RunRecord& record);

/// series.csv: a line a number: feature, series, row, column, value; hidden truth is left out.
[[nodiscard]] std::string write_series_csv(const record::RunRecord& record);

/// A few lines for the terminal: verdict, each characteristic, the zone, warnings.
[[nodiscard]] std::string write_summary(const record::RunRecord& record,
                                        const Evaluation& evaluation);

}  // namespace rondure::reports
