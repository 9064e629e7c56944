#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "record/archive/archive.h"
#include "record/run_record.h"
#include "reports/history/run_chart.h"

namespace rondure::reports {

/// Results of earlier runs as the archive returned them when the reports of a run were first
/// written, newest first. earlier.json of the run directory holds them, so that the page with its
/// run chart can be written again, and verified, without the archive.
using EarlierResults = std::vector<record::ArchivedResult>;

inline constexpr const char* kEarlierName = "earlier.json";
/// Number of newest results that are kept.
inline constexpr std::size_t kMostEarlier = 1000;

/// Values stay in the archive's unit, so that they read back to the same double.
[[nodiscard]] std::string earlier_json(const EarlierResults& earlier);
/// @return kSyntax for a text that earlier_json() would not write.
[[nodiscard]] core::Result<EarlierResults> parse_earlier(const std::string& text);

/// Reads earlier.json of a run directory; empty when there is none. Errors as parse_earlier().
[[nodiscard]] core::Result<EarlierResults> read_earlier(const std::filesystem::path& directory);
/// Writes earlier.json and its digest into SHA256SUMS; writes nothing for no results. Errors:
/// kFile, kSyntax for an invalid SHA256SUMS.
[[nodiscard]] core::Result<void> keep_earlier(const std::filesystem::path& directory,
                                              const EarlierResults& earlier);

/// Run charts of the characteristics of a run: those with at least two results, counting this run's
/// and comparable earlier ones.
[[nodiscard]] std::vector<RunChart> run_charts(const record::RunRecord& record,
                                               const evaluation::Evaluation& evaluation,
                                               const EarlierResults& earlier);

}  // namespace rondure::reports
