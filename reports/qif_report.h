#pragma once

#include <string>

#include "record/run_record.h"
#include "reports/evaluation.h"

namespace rondure::reports {

/// report.qif: a results document of QIF 3.0 (ISO 23952): features, characteristics, points, what
/// measured. Lengths in mm. Valid against its schema; check_qif() checks what the schema does not.
[[nodiscard]] std::string write_qif(const record::RunRecord& record, const Evaluation& evaluation);

}  // namespace rondure::reports
