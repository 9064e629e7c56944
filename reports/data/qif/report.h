#pragma once

#include <string>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// report.qif: a results document of QIF 3.0 (ISO 23952): features, characteristics, points,
/// measuring devices. Lengths in mm. Valid against its schema; check_qif() checks the rest.
[[nodiscard]] std::string write_qif(const record::RunRecord& record,
                                    const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
