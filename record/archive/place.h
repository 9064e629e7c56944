#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/result.h"

namespace rondure::record {

/// Names beside the run directories: the archive where none is named, and the runs that wait for an
/// archive that could not be reached.
inline constexpr const char* kArchiveName = "archive.db";
inline constexpr const char* kArchiveQueueName = "archive-queue.db";

/// Where results are archived.
struct ArchivePlace {
  enum class Kind {
    kNone,    ///< "none": nothing is archived.
    kFile,    ///< A file of SQLite.
    kServer,  ///< A PostgreSQL server.
  };
  Kind kind = Kind::kNone;
  std::string address;  ///< Path, or URL as given, with its password.
  std::string shown;    ///< The same without password, for messages.
  std::string key;      ///< What it is from any working directory: absolute path, or `shown`.

  /// The URL holds a password. It belongs into ~/.pgpass and not into a plan.
  [[nodiscard]] bool has_password() const { return address != shown; }
};

/// Reads "none", a path, or "postgresql://user@host:port/database?..." (also "postgres://"), as
/// libpq takes it. kBadOption for another scheme, an empty text, settings that are no URL, or a URL
/// that libpq cannot read or in which a password could not be told from the rest (a second "@").
///
/// @param folder  A relative path is relative to it; empty: to the working directory.
[[nodiscard]] core::Result<ArchivePlace> parse_archive_place(
    std::string_view text, const std::filesystem::path& folder = {});

/// The folder that holds a run directory, also for "runs/7/" and ".": where the archive and the
/// queue stand when nothing else is named.
[[nodiscard]] std::filesystem::path folder_beside(const std::filesystem::path& run_directory);

}  // namespace rondure::record
