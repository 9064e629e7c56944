#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "evaluation/results/evaluation.h"
#include "record/run_record.h"

namespace rondure::reports {

/// report.json: every number of the evaluation, in um and deg where the key says so; keys in a
/// fixed order; numbers in the shortest form that reads back to the same double.
[[nodiscard]] std::string write_json(const record::RunRecord& record,
                                     const evaluation::Evaluation& evaluation);

/// report.json as a document, keys in their published order (docs/report.md). "/probe" and
/// "/features" depend on the evaluation alone; a number that is not finite is written as null.
[[nodiscard]] nlohmann::ordered_json report_document(const record::RunRecord& record,
                                                     const evaluation::Evaluation& evaluation);

}  // namespace rondure::reports
