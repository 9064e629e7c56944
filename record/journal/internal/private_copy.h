#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/result.h"

// Private to the room.

namespace rondure::record {

/// What SQLite would apply to a journal as it opens it: the names of the files beside it, a
/// write-ahead log or a rollback journal, that are not empty.
[[nodiscard]] std::vector<std::string> logs_beside(const std::filesystem::path& journal);

/// The journal, alone or with its logs, copied into a folder of our own: SQLite may then finish
/// what a killed run left in the log, and the original is never touched, not even in a read-only
/// place. The folder is locked while it is in use; what a killed program left is removed by the
/// next copy.
class PrivateCopy {
 public:
  enum class Logs { kWith, kWithout };

  /// Copies `journal` and, if wanted, the logs beside it; kFile when that fails, kJournal for a log
  /// that would change other files than the journal.
  [[nodiscard]] static core::Result<PrivateCopy> of(const std::filesystem::path& journal,
                                                    Logs logs = Logs::kWith);

  PrivateCopy(PrivateCopy&& other) noexcept;
  PrivateCopy& operator=(PrivateCopy&&) = delete;
  ~PrivateCopy();  ///< Removes the copy.

  /// The copied database.
  [[nodiscard]] std::filesystem::path file() const;

 private:
  PrivateCopy(std::filesystem::path folder, int lock);
  /// With an empty folder when none can be made (errno).
  [[nodiscard]] static PrivateCopy in_new_folder(const std::filesystem::path& place);
  [[nodiscard]] std::error_code take(const std::filesystem::path& journal, Logs logs) const;

  std::filesystem::path folder_;
  int lock_ = -1;  ///< The open folder.
};

}  // namespace rondure::record
