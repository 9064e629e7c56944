#pragma once

#include <filesystem>
#include <vector>

#include "core/result.h"

// Private to the room: the directory and the empty file of a new journal.

namespace rondure::record {

/// Removes what was made for a journal, last first, unless `made` is cleared.
struct Undo {
  std::vector<std::filesystem::path> made;

  Undo() = default;
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;
  ~Undo();
};

/// Makes the directory of `file` where it is missing, and the empty file in it, so that two runs
/// can never share one. kFile when that fails or the directory holds anything.
[[nodiscard]] core::Result<void> make_empty_journal(const std::filesystem::path& file, Undo& undo);

/// The new names reach the disk before the first touch does; kFile.
[[nodiscard]] core::Result<void> sync_names(const Undo& undo);

}  // namespace rondure::record
