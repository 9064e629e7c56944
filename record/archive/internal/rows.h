#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <soci/soci.h>

#include "record/archive/archive.h"

// Private to the room: runs and results to rows and back. Everything here throws soci::soci_error.

namespace rondure::record {

/// Inserts a run with its results, unless its journal is there already. Inside a transaction.
/// @param time_s  Its start, as a number.
/// @return Whether it was new.
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
