#pragma once

#include <filesystem>
#include <string>

#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "core/result.h"

// Private to the room: the few SQLite functions that the journal needs, through SOCI.

namespace rondure::record {

/// The connection string with which SOCI opens an SQLite file; kFile when the path contains a
/// double quote, which cannot be expressed in it.
[[nodiscard]] core::Result<std::string> connection_string(const std::filesystem::path& file);

/// SQLite's own handle of a session.
[[nodiscard]] sqlite_api::sqlite3* handle_of(soci::session& session);

/// Stops SQLite from running anything stored in the file itself (triggers, views, functions in its
/// schema), and makes it report damaged cells when they are read. Call it for every file that may
/// come from elsewhere. @throws  soci::soci_error.
void distrust(soci::session& sql);

/// The cause of a failed SOCI or SQLite call and the remedy, in words: "the disk is full; free
/// space on the disk".
[[nodiscard]] std::string reason_of(const std::exception& exception, soci::session* session);

// The write-ahead log of a journal; all three throw.

/// Sets the modes of an open journal. Exclusive: no other program can delay a touch. WAL and
/// synchronous=full: one flush per commit, on disk when the call returns.
void enable_wal(soci::session& sql);

/// Moves the write-ahead log into the file.
void checkpoint_wal(soci::session& sql);

/// Leaves WAL mode: afterwards the journal is one file.
void disable_wal(soci::session& sql);

}  // namespace rondure::record
