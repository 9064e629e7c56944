#pragma once

#include <string>
#include <string_view>

#include "evaluation/evaluation.h"
#include "record/run_record.h"
#include "reports/history/earlier_results.h"
#include "reports/terminal/polar_sketch.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// report.json: every number of the evaluation, in um and deg where the key says so; keys in a
/// fixed order; numbers in the shortest form that reads back to the same double.
[[nodiscard]] std::string write_json(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation);

/// report.html: one self-contained page (no network, no script needed to read it).
/// @param earlier  Results of earlier runs, for its run charts.
[[nodiscard]] std::string write_html(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation,
                                     Language language = Language::kEnglish,
                                     const EarlierResults& earlier = {});
/// The language that write_html() wrote a page in, as the page itself states it; English for
/// anything else.
[[nodiscard]] Language language_of_page(std::string_view page);

/// touches.csv: a row a touch, as journalled.
[[nodiscard]] std::string write_touches_csv(const record::RunRecord& record);

/// series.csv: a line a number: feature, series, row, column, value; hidden truth is left out.
[[nodiscard]] std::string write_series_csv(const record::RunRecord& record);

/// results.csv: a row a characteristic: value, tolerance, verdict, how it came about.
[[nodiscard]] std::string write_results_csv(const record::RunRecord& record,
                                            const evaluation::Evaluation& evaluation);

/// report.qif: a results document of QIF 3.0 (ISO 23952): features, characteristics, points, what
/// measured. Lengths in mm. Valid against its schema; check_qif() checks what the schema does not.
[[nodiscard]] std::string write_qif(const record::RunRecord& record,
                                    const evaluation::Evaluation& evaluation);

/// report.dmo: actual features and tolerances as a DMIS (ISO 22093) output block. ASCII, mm.
[[nodiscard]] std::string write_dmis(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation);

/// A few lines for the terminal: verdict, each characteristic, the zone, warnings; with a small
/// drawing of the worst section of each feature where the terminal can show one.
[[nodiscard]] std::string write_summary(const record::RunRecord& record,
                                        const evaluation::Evaluation& evaluation,
                                        SketchStyle sketch = SketchStyle::kNone,
                                        Language language = Language::kEnglish);

}  // namespace rondure::reports
