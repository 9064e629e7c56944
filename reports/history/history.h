#pragma once

#include <span>
#include <string>
#include <vector>

#include "record/archive/archive.h"
#include "reports/history/run_chart.h"

namespace rondure::reports {

/// Whether two results are of one run of an archive.
[[nodiscard]] bool in_one_run(const record::ArchivedResult& one,
                              const record::ArchivedResult& other);

/// Runs as a table of 80 columns, a line each, oldest first: how many results conform, and the one
/// that decides or is nearest to its limit.
/// @param newest_first  In the order of Archive::newest().
[[nodiscard]] std::string history_table(std::span<const record::ArchivedResult> newest_first);

/// The run chart for a terminal of 80 columns; `coloured` marks results beyond a limit.
[[nodiscard]] std::string history_chart(const RunChart& chart, bool coloured);

/// The run chart as a complete SVG file.
[[nodiscard]] std::string history_svg(const RunChart& chart);

/// The run chart as a drawing of the page, and the sentences below it.
[[nodiscard]] std::string history_drawing(const RunChart& chart);
[[nodiscard]] std::vector<core::Phrase> history_sentences(const RunChart& chart);

/// The header line of the CSV file, and its rows in the order given.
[[nodiscard]] std::string history_csv_header();
[[nodiscard]] std::string history_csv_rows(std::span<const record::ArchivedResult> newest_first);

/// Results and chart as JSON; docs/archive.md has the keys.
/// @param archive  Its place, without a password.
/// @param more     Whether older results pass the filter.
[[nodiscard]] std::string history_json(const std::string& archive,
                                       std::span<const record::ArchivedResult> newest_first,
                                       bool more, const RunChart& chart);

}  // namespace rondure::reports
