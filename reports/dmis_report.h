#pragma once

#include <string>

#include "record/run_record.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// report.dmo: actual features and tolerances as a DMIS (ISO 22093) output block. ASCII, mm.
[[nodiscard]] std::string write_dmis(const record::RunRecord& record, const Evaluation& evaluation);

}  // namespace rondure::reports
