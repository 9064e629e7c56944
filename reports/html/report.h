#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/data/corrections.h"
#include "reports/history/earlier_results.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// How a page is written.
struct Edition {
  Language language = Language::kEnglish;
  bool detail = false;  ///< Call-outs that conform, numbers and searches are open, on paper too.

  Edition() = default;
  Edition(Language of, bool open = false)  // NOLINT(google-explicit-constructor): most pages
      : language(of), detail(open) {}
  friend bool operator==(const Edition& a, const Edition& b) = default;
};

/// report.html: one self-contained page (needs no network, and no script to be read).
/// @param earlier      Results of earlier runs, for its run charts.
/// @param corrections  What each feature hands on to machines; empty: the page names none.
[[nodiscard]] std::string write_html(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation, Edition edition = {},
                                     const EarlierResults& earlier = {},
                                     const std::vector<FeatureCorrections>& corrections = {});
/// How a page from write_html() was written, as the page itself states it; for anything else
/// English and without detail.
[[nodiscard]] Edition edition_of_page(std::string_view page);

}  // namespace rondure::reports
