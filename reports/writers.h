#pragma once

// For report.pdf and report.junit.xml alone; it goes with them.

#include <string>

#include "record/run_record.h"
#include "reports/evaluation.h"
#include "reports/feature_values.h"
#include "reports/html_report.h"

namespace rondure::reports {

/// report.junit.xml: a test case a characteristic, for pipelines. What does not conform and what is
/// undecided fail, void is an error, what has no tolerance is skipped.
[[nodiscard]] std::string write_junit(const record::RunRecord& record,
                                      const Evaluation& evaluation);

}  // namespace rondure::reports
