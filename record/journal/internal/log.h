#pragma once

#include <soci/soci.h>

// Private to the room: the write-ahead log of a journal. Everything here throws.

namespace rondure::record {

/// Sets the modes of an open journal. Exclusive: no other program can delay a touch. WAL and
/// synchronous=full: one flush per commit, on disk when the call returns.
void enable_wal(soci::session& sql);

/// Moves the write-ahead log into the file.
void checkpoint_wal(soci::session& sql);

/// Leaves WAL mode: afterwards the journal is one file.
void disable_wal(soci::session& sql);

}  // namespace rondure::record
