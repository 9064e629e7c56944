#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "evaluation/results/evaluation.h"
#include "plans/plan.h"
#include "record/archive/archive.h"
#include "record/run_record.h"

namespace rondure::app {

/// The archive for the results of a run: `argument` (--archive), otherwise that of the plan,
/// otherwise archive.db beside the run directory. kBadOption as parse_archive_place().
[[nodiscard]] core::Result<record::ArchivePlace> archive_of(const std::string& argument,
                                                            const plans::Plan& plan,
                                                            const std::filesystem::path& directory);

/// Converts a sealed run for the archive; kFile when its journal cannot be read.
[[nodiscard]] core::Result<record::ArchiveRun> entry_of(const std::filesystem::path& directory,
                                                        const record::RunRecord& record,
                                                        const evaluation::Evaluation& evaluation);

/// Stores the earlier results of a run's part in its directory (earlier.json), for the run charts
/// of its page: once, before its reports are first written. Without a readable archive the page has
/// no run chart; archive_run() reports the problem.
void keep_earlier_results(const record::ArchivePlace& place, const std::filesystem::path& directory,
                          const record::RunRecord& record);

/// Pushes a sealed run whose reports are written. If that fails, the run is queued beside the run
/// directory, with a message. Does not change the exit status of the run.
/// @return  Whether there was anything to do: false when the archive already held the run, or there
///          is no archive.
/// @param quiet  Says nothing of a success.
bool archive_run(const record::ArchivePlace& place, const std::filesystem::path& directory,
                 const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                 bool quiet);

}  // namespace rondure::app
