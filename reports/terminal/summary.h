#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// A few lines for the terminal: verdict, each characteristic, the zone, warnings.
[[nodiscard]] std::string write_summary(const record::RunRecord& record,
                                        const evaluation::Evaluation& evaluation,
                                        Language language = Language::kEnglish);

}  // namespace rondure::reports
