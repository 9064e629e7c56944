#pragma once

#include <cstdint>
#include <vector>

#include <soci/soci.h>

#include "record/journal/journal.h"

// Private to the room: the seal that closes a journal. Throws soci::soci_error.

namespace rondure::record {

/// Fills the seal with the digest of every other table and the head of the chain.
/// @param version  Of the tables.
void insert_seal(soci::session& sql, std::int64_t version);

[[nodiscard]] bool is_sealed(soci::session& sql);

/// Checks the chain (from version 2) and, in a sealed journal, every digest of the seal. A table
/// that fails both is reported once, with the number of rows and the name of the first bad row.
[[nodiscard]] std::vector<BrokenTable> check_seal(soci::session& sql, std::int64_t version);

}  // namespace rondure::record
