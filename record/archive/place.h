#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// File names beside the run directories: the default archive, and the queue of runs for an archive
/// that could not be reached.
inline constexpr const char* kArchiveName = "archive.db";
inline constexpr const char* kArchiveQueueName = "archive-queue.db";

/// Location of the archive.
struct ArchivePlace {
  enum class Kind {
    kNone,    ///< "none": nothing is archived.
    kFile,    ///< A file of SQLite.
    kServer,  ///< A PostgreSQL server.
  };
  Kind kind = Kind::kNone;
  std::string address;  ///< Path, or the URL as given, with its password.
  std::string shown;    ///< The same without password, for messages.
  std::string key;      ///< Independent of the working directory: absolute path, or `shown`.

  /// Whether the URL contains a password, which belongs in ~/.pgpass, not in a plan.
  [[nodiscard]] bool has_password() const { return address != shown; }
};

/// Parses "none", a path, or "postgresql://user@host:port/database?..." (also "postgres://") in the
/// syntax of libpq. kBadOption for another scheme, an empty text, settings that are not a URL, a
/// URL that libpq cannot read, or one in which the password cannot be separated from the rest (a
/// second "@"). kFile where the library of PostgreSQL is not installed.
///
/// @param folder  A relative path is relative to it; empty: to the working directory.
[[nodiscard]] core::Result<ArchivePlace> parse_archive_place(
    std::string_view text, const std::filesystem::path& folder = {});

/// The folder that holds a run directory, also for "runs/7/" and ".". The archive and the queue are
/// there when no other place is named.
[[nodiscard]] std::filesystem::path folder_beside(const std::filesystem::path& run_directory);

}  // namespace rondure::record
