#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"
#include "reports/terminal/polar_sketch.h"
#include "reports/words/language.h"

namespace rondure::reports {

/// A few lines for the terminal: verdict, each characteristic, the zone, warnings; with a small
/// drawing of the worst section of each feature on terminals that can show one.
[[nodiscard]] std::string write_summary(const record::RunRecord& record,
                                        const evaluation::Evaluation& evaluation,
                                        SketchStyle sketch = SketchStyle::kNone,
                                        Language language = Language::kEnglish);

}  // namespace rondure::reports
