#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <soci/soci.h>

#include "core/result.h"
#include "record/archive/archive.h"
#include "record/archive/internal/schema.h"

// Private to the room: a connection to an archive of either kind.

namespace rondure::record {

struct ArchiveSession {
  ArchivePlace place;
  const Dialect* dialect = nullptr;
  soci::session sql;
};

/// Connects and sees that the tables are there, of the version this program knows; kWrite makes
/// them where there is nothing. Errors as Archive::open().
[[nodiscard]] core::Result<std::unique_ptr<ArchiveSession>> open_archive_session(
    const ArchivePlace& place, Archive::Access access);

/// Runs `work` in one transaction that writes: all of it is there afterwards, or nothing. kArchive.
[[nodiscard]] core::Result<void> write_in_one(ArchiveSession& session,
                                              const std::function<void()>& work);

/// "the archive X cannot be read: why; what to do", kArchive.
[[nodiscard]] tl::unexpected<core::Error> archive_failure(const ArchivePlace& place,
                                                          std::string_view participle,
                                                          const std::exception& exception,
                                                          soci::session* session);

}  // namespace rondure::record
