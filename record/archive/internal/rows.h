#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <soci/soci.h>

#include "record/archive/archive.h"

namespace rondure::record {

// Private to the room: the tables of an archive, the same on both kinds of database.
// docs/archive.md explains them; a test checks that both agree.

/// SQL that differs between the two databases.
struct Dialect {
  std::string_view id_type;      ///< Type of a column with automatic row numbers.
  std::string_view has_archive;  ///< Query: 1 when the tables of this program exist.
  std::string_view begin;        ///< Starts a transaction that writes.
  std::string_view lock;  ///< Prevents a second program from creating the tables; may be empty.
};

[[nodiscard]] const Dialect& sqlite_dialect();
[[nodiscard]] const Dialect& postgresql_dialect();

/// The statements that create an archive.
[[nodiscard]] std::vector<std::string> archive_statements(const Dialect& dialect);

/// A number that represents a name in an index: PostgreSQL cannot index text longer than 2.7 kB.
/// Two names may share a number, so the names of the rows found are compared as well.
[[nodiscard]] std::int64_t key_of(std::string_view name);

// Private to the room: converts runs and results to rows and back. All functions throw
// soci::soci_error.

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
