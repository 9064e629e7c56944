#pragma once

#include <filesystem>
#include <string>

#include <soci/soci.h>

#include "core/result.h"

// Private to the room: the small part of SQLite that the journal needs, over SOCI.

namespace rondure::record {

/// What SOCI's session wants to hear to open a file of SQLite; kFile when the path cannot be said
/// in it (a double quote).
[[nodiscard]] core::Result<std::string> connection_string(const std::filesystem::path& file);

/// From now on nothing that stands in the file itself is run: no triggers, no views, no functions
/// in its schema; damaged cells are found as they are read. For every file that somebody else may
/// have written. @throws  soci::soci_error.
void distrust(soci::session& sql);

/// What a failed call of SOCI or SQLite means, in words, and what can be done about it:
/// "the disk is full; free space on the disk".
[[nodiscard]] std::string reason_of(const std::exception& exception, soci::session* session);

}  // namespace rondure::record
