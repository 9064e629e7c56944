#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "evaluation/evaluation.h"
#include "plans/plan.h"
#include "record/archive/archive.h"
#include "record/run_record.h"

namespace rondure::app {

/// Where the results of a run go: `argument` (--archive), else what the plan says, else archive.db
/// beside the run directory. kBadOption as parse_archive_place().
[[nodiscard]] core::Result<record::ArchivePlace> archive_of(const std::string& argument,
                                                            const plans::Plan& plan,
                                                            const std::filesystem::path& directory);

/// A sealed run as the archive keeps it; kFile when its journal cannot be read.
[[nodiscard]] core::Result<record::ArchiveRun> entry_of(const std::filesystem::path& directory,
                                                        const record::RunRecord& record,
                                                        const evaluation::Evaluation& evaluation);

/// Keeps the earlier results of a run's part in its directory (earlier.json), for the run charts of
/// its page: once, before its reports are first written. Without an archive, or where it cannot be
/// read, the page has no run chart; pushing the run says what is wrong with the archive.
void keep_earlier_results(const record::ArchivePlace& place, const std::filesystem::path& directory,
                          const record::RunRecord& record);

/// Pushes a sealed run whose reports are written. What cannot be pushed waits in the queue beside
/// the run directory; a message says so. Never changes how the run ends.
/// @return  Whether there was anything to do: false when the archive held it, or none is wanted.
bool archive_run(const record::ArchivePlace& place, const std::filesystem::path& directory,
                 const record::RunRecord& record, const evaluation::Evaluation& evaluation);

}  // namespace rondure::app
