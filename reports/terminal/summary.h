#pragma once

#include <string>
#include <string_view>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// What the terminal shows of a run in lines of 80 columns: how many call-outs conform, a line for
/// each of them, details of those that do not conform, what is in U and what is not.
[[nodiscard]] std::string write_answer(const record::RunRecord& record,
                                       const evaluation::Evaluation& evaluation,
                                       Language language = Language::kEnglish);

/// The same with all details: rule, part, run; zones, certificates, warnings of every feature.
[[nodiscard]] std::string write_summary(const record::RunRecord& record,
                                        const evaluation::Evaluation& evaluation,
                                        Language language = Language::kEnglish);

/// The last line, without its end: where the report is, and the command that comes next.
/// @param next  Empty: none.
[[nodiscard]] std::string write_whereabouts(std::string_view report, std::string_view next,
                                            Language language = Language::kEnglish);

}  // namespace rondure::reports
