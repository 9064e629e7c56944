#pragma once

#include <string>
#include <vector>

#include "evaluation/analysis.h"

namespace rondure::reports {

/// A line of the terminal's summary: at most 13 characters of name, then text.
struct SummaryLine {
  std::string name;
  std::string text;
};

/// What the summary says of an analysis, in English.
[[nodiscard]] std::vector<SummaryLine> summary_lines(const evaluation::AnalysisResult& result);

}  // namespace rondure::reports
