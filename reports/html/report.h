#pragma once

#include <string>
#include <string_view>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/history/earlier_results.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// report.html: one self-contained page (needs no network, and no script to be read).
/// @param earlier  Results of earlier runs, for its run charts.
[[nodiscard]] std::string write_html(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation,
                                     Language language = Language::kEnglish,
                                     const EarlierResults& earlier = {});
/// The language of a page from write_html(), as the page itself states it; English for anything
/// else.
[[nodiscard]] Language language_of_page(std::string_view page);

}  // namespace rondure::reports
