#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"
#include "record/run_lock.h"

// Private to the room: the directory and the empty file of a new journal.

namespace rondure::record {

/// Removes the files and folders created for a journal, last first, unless `made` is cleared.
struct Undo {
  std::vector<std::filesystem::path> made;

  Undo() = default;
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;
  ~Undo();
};

/// Creates a directory where it is missing and takes its lock. kFile when that fails, when another
/// process holds the lock, or when the directory holds anything else; nothing is written then.
[[nodiscard]] core::Result<RunLock> lock_new_directory(const std::filesystem::path& directory,
                                                       Undo& undo);

/// Creates the empty file of a journal exclusively, so that two runs never share one; kFile.
[[nodiscard]] core::Result<void> make_empty_journal(const std::filesystem::path& file, Undo& undo);

/// Flushes the new directory entries to disk before the first touch is written; kFile.
[[nodiscard]] core::Result<void> sync_names(const Undo& undo);

}  // namespace rondure::record
