#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <soci/soci.h>

#include "record/archive/archive.h"

// Private to the room: converts runs and results to rows and back. All functions throw
// soci::soci_error.

namespace rondure::record {

/// Version of the tables, -1 where it is not told.
[[nodiscard]] int archive_version(soci::session& sql);

/// Inserts a run with its results, unless the archive holds its journal already. Call it inside a
/// transaction.
/// @param time_s  Start of the run, seconds since 1970.
/// @return Whether the run was new.
bool insert_run(soci::session& sql, const ArchiveRun& run, std::int64_t time_s);

/// The newest results that pass the filter.
[[nodiscard]] std::vector<ArchivedResult> select_newest(soci::session& sql,
                                                        const ArchiveFilter& filter,
                                                        std::size_t count,
                                                        const ArchivedResult* before);

/// The run with this journal, or nothing.
[[nodiscard]] std::optional<ArchiveRun> select_run(soci::session& sql,
                                                   const std::string& journal_sha256);

}  // namespace rondure::record
