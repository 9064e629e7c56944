#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <soci/soci.h>

#include "core/result.h"
#include "record/archive/archive.h"
#include "record/archive/internal/rows.h"

// Private to the room: a connection to an archive of either kind.

namespace rondure::record {

struct ArchiveSession {
  ArchivePlace place;
  const Dialect* dialect = nullptr;
  soci::session sql;
};

/// Connects and checks that the tables exist and have the version of this program; kWrite creates
/// them in an empty database. Errors as Archive::open().
[[nodiscard]] core::Result<std::unique_ptr<ArchiveSession>> open_archive_session(
    const ArchivePlace& place, Archive::Access access);

/// Runs `work` in one writing transaction: afterwards all of it is stored, or nothing. kArchive.
[[nodiscard]] core::Result<void> write_in_one(ArchiveSession& session,
                                              const std::function<void()>& work);

/// Makes the kArchive error "the archive X cannot be read: why; what to do".
[[nodiscard]] tl::unexpected<core::Error> archive_failure(const ArchivePlace& place,
                                                          std::string_view participle,
                                                          const std::exception& exception,
                                                          soci::session* session);

/// Runs `read` and returns its result. kArchive.
template <class T, class Read>
core::Result<T> read_from(ArchiveSession& session, const Read& read) {
  try {
    return read();
  } catch (const std::exception& exception) {
    return archive_failure(session.place, "read", exception, &session.sql);
  }
}

}  // namespace rondure::record
