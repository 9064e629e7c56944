#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include <soci/soci.h>

#include "core/result.h"
#include "record/internal/database.h"

// Private to the room.

namespace rondure::record {

/// The names of the non-empty files beside a journal, a write-ahead log or a rollback journal, that
/// SQLite would apply when it opens the journal.
[[nodiscard]] std::vector<std::string> logs_beside(const std::filesystem::path& journal);

/// A copy of the journal, alone or with its logs, in a private folder. SQLite may finish the log of
/// a killed run in the copy; the original is never changed and may be in a read-only place. The
/// folder is locked while it is in use. The next copy removes the folders of killed programs.
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
  /// Has an empty path when the folder cannot be created (errno).
  [[nodiscard]] static PrivateCopy in_new_folder(const std::filesystem::path& place);
  [[nodiscard]] std::error_code take(const std::filesystem::path& journal, Logs logs) const;

  std::filesystem::path folder_;
  int lock_ = -1;  ///< Descriptor of the open folder.
};

/// Runs `look` on the database in a private copy and returns its result; nothing when the file is
/// no database or is damaged. kFile, kJournal when it cannot be copied.
template <class Look>
auto in_copy(const std::filesystem::path& journal, PrivateCopy::Logs logs, const Look& look)
    -> core::Result<std::optional<std::invoke_result_t<Look, soci::session&>>> {
  const auto copy = PrivateCopy::of(journal, logs);
  if (!copy) return core::fail(copy.error());
  const auto connection = connection_string(copy->file());
  if (!connection) return core::fail(connection.error());
  try {
    soci::session sql(soci::sqlite3, *connection);
    distrust(sql);
    return std::optional(look(sql));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace rondure::record
