#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// report.dmo: actual features and tolerances as a DMIS (ISO 22093) output block. ASCII, mm.
[[nodiscard]] std::string write_dmis(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
