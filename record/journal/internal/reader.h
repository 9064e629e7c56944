#pragma once

#include <soci/soci.h>

#include "record/journal/internal/values.h"
#include "record/journal/journal.h"

// Private to the room: reads the rows of a journal as records.

namespace rondure::record {

/// Throws Contradiction unless the file holds exactly the tables of docs/developer/journal.md, byte
/// for byte, and no index, view, trigger or other table.
void require_schema(soci::session& sql);

/// Reads and checks every table of an open journal. Throws soci::soci_error, Contradiction, Damage.
[[nodiscard]] ReadJournal read_tables(soci::session& sql);

}  // namespace rondure::record
