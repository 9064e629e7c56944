#include <cerrno>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/checksums.h"
#include "record/database.h"
#include "record/files.h"
#include "record/journal_damage.h"
#include "record/journal_reader.h"
#include "record/private_copy.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

bool is_damage(const std::exception& exception) {
  const auto* error = dynamic_cast<const soci::sqlite3_soci_error*>(&exception);
  return (error != nullptr && (error->result() & 0xff) == SQLITE_CORRUPT) ||
         dynamic_cast<const Damage*>(&exception) != nullptr;
}

constexpr const char* kCopyAgain =
    "copy the run directory again from where it was measured, or from a backup";

std::string advice_after(const std::string& loss) {
  return fmt::format("{}{}; {}", loss.empty() ? "" : "; ", loss, kCopyAgain);
}

/// Whether nothing of a journal is there but its name.
bool holds_nothing(const fs::path& file) {
  std::error_code absent;
  const auto log = fs::file_size(file.string() + "-wal", absent);
  return (absent || log == 0) && fs::file_size(file, absent) == 0 && !absent;
}

core::Result<void> require_file(const fs::path& directory, const fs::path& file) {
  std::error_code problem;
  const fs::file_status status = fs::status(file, problem);
  const auto refuse = [&](std::string what) {
    return core::fail(core::Code::kFile, std::move(what), file.string());
  };
  if (fs::is_regular_file(status) && holds_nothing(file)) {
    return core::fail(
        core::Code::kJournal,
        fmt::format("the journal cannot be read: it is empty; a run that died as it began left it, "
                    "then begin again, or its contents were lost, then {}",
                    kCopyAgain),
        file.string());
  }
  if (fs::is_regular_file(status)) return {};
  const bool lost = fs::exists(directory / kChecksumsName, problem);
  if (status.type() == fs::file_type::not_found && lost) {
    return refuse(fmt::format("there is no {} in {}, but a {}: the journal of a run was lost; {}",
                              kJournalName, directory.string(), kChecksumsName, kCopyAgain));
  }
  if (status.type() == fs::file_type::not_found) {
    return refuse(fmt::format("there is no {} in {}; name the directory of a run", kJournalName,
                              directory.string()));
  }
  if (fs::exists(status)) return refuse("the journal is not a file; name the directory of a run");
  return refuse(fmt::format("the journal cannot be looked at: {}", system_reason(problem.value())));
}

}  // namespace

core::Result<ReadJournal> read_journal(const fs::path& directory) {
  const fs::path file = directory / kJournalName;
  if (auto found = require_file(directory, file); !found) return core::fail(found.error());
  const auto copy = PrivateCopy::of(file);
  if (!copy) return core::fail(copy.error());
  const auto connection = connection_string(copy->file());
  if (!connection) return core::fail(connection.error());
  std::optional<soci::session> sql;
  std::string reason;
  try {
    sql.emplace(soci::sqlite3, *connection);
    *sql << "pragma synchronous = off";  // the copy need not survive a power cut
    return read_tables(*sql);
  } catch (const std::exception& exception) {
    reason = reason_of(exception, sql ? &*sql : nullptr);
    if (is_damage(exception)) {
      sql.reset();
      reason += advice_after(loss_in_words(copy->file()));
    }
  }
  return core::fail(core::Code::kJournal, fmt::format("the journal cannot be read: {}", reason),
                    file.string());
}

}  // namespace rondure::record
