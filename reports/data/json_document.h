#pragma once

#include <nlohmann/json.hpp>

#include "evaluation/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// report.json as a document, keys in their published order (docs/report.md). Included by sources
/// of this room only. "/probe" and "/features" depend on the evaluation alone; a number that is not
/// finite stands as null.
[[nodiscard]] nlohmann::ordered_json report_document(const record::RunRecord& record,
                                                     const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
