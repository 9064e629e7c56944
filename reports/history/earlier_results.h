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

/// Results of earlier runs as the archive gave them when the reports of a run were first made,
/// newest first. They stand in earlier.json of the run directory, so that the page with its run
/// chart can be made again, and verified, without the archive.
using EarlierResults = std::vector<record::ArchivedResult>;

inline constexpr const char* kEarlierName = "earlier.json";
/// As many of the newest results are kept.
inline constexpr std::size_t kMostEarlier = 1000;

/// Values stay in the archive's unit, so that they come back to the same double.
[[nodiscard]] std::string earlier_json(const EarlierResults& earlier);
/// @return kSyntax for a text that earlier_json() would not write.
[[nodiscard]] core::Result<EarlierResults> parse_earlier(const std::string& text);

/// Those of a run directory; none when it has no earlier.json. Errors as parse_earlier().
[[nodiscard]] core::Result<EarlierResults> read_earlier(const std::filesystem::path& directory);
/// Writes earlier.json and its digest into SHA256SUMS; nothing for no results. Errors: kFile,
/// kSyntax of a SHA256SUMS that is none.
[[nodiscard]] core::Result<void> keep_earlier(const std::filesystem::path& directory,
                                              const EarlierResults& earlier);

/// Run charts of the characteristics of a run: those with at least two results, this run's and
/// earlier ones that mean the same.
[[nodiscard]] std::vector<RunChart> run_charts(const record::RunRecord& record,
                                               const evaluation::Evaluation& evaluation,
                                               const EarlierResults& earlier);

}  // namespace rondure::reports
