#pragma once

#include <string>
#include <string_view>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/history/earlier_results.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// report.html: one self-contained page (no network, no script needed to read it).
/// @param earlier  Results of earlier runs, for its run charts.
[[nodiscard]] std::string write_html(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation,
                                     Language language = Language::kEnglish,
                                     const EarlierResults& earlier = {});
/// The language that write_html() wrote a page in, as the page itself states it; English for
/// anything else.
[[nodiscard]] Language language_of_page(std::string_view page);

}  // namespace rondure::reports
