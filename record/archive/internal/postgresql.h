#pragma once

#include <libpq-fe.h>
#include <soci/soci.h>

#include "core/result.h"

namespace rondure::record {

/// What an archive on a server needs of SOCI's part for PostgreSQL and of libpq below it.
///
/// The two bring some twenty libraries more, a third of the time in which the program starts. They
/// are loaded when a URL is read, and stay.
struct PostgresqlLibrary {
  soci::backend_factory const* (*factory)() = nullptr;
  decltype(&PQconninfoParse) parse = nullptr;
  decltype(&PQconninfoFree) free_settings = nullptr;
  decltype(&PQfreemem) free_words = nullptr;
};

/// The library as it was loaded first. kFile: it is not installed, or is another one.
[[nodiscard]] const core::Result<PostgresqlLibrary>& postgresql();

/// Loads a library by its name. kFile as above.
[[nodiscard]] core::Result<PostgresqlLibrary> load_postgresql(const char* name);

}  // namespace rondure::record
