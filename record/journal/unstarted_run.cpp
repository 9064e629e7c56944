#include "record/journal/journal.h"

#include <algorithm>
#include <array>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "record/files.h"
#include "record/journal/internal/private_copy.h"
#include "record/run_lock.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

using Logs = PrivateCopy::Logs;

bool holds_no_table(soci::session& sql) {
  int tables = 0;
  long long application = 0;
  sql << "select count(*) from sqlite_schema", soci::into(tables);
  sql << "pragma application_id", soci::into(application);
  return tables == 0 && application == 0;
}

/// Whether a journal has no tables after SQLite has finished its log. A file that has tables
/// without its log is a journal, whatever the log contains.
core::Result<bool> is_unstarted(const fs::path& journal) {
  TRY(const auto alone, in_copy(journal, Logs::kWithout, holds_no_table));
  if (!alone.value_or(true)) return false;
  TRY(const auto whole, in_copy(journal, Logs::kWith, holds_no_table));
  return whole.value_or(false);  // the reader of journals reports a damaged one
}

constexpr std::array kSuffixes = {"-shm", "-wal", "-journal", ""};  ///< Files of one journal.

/// Whether a directory holds only the first files of a run. Beside reports or a list of digests, an
/// empty journal is one that lost its contents.
bool holds_only_a_beginning(const fs::path& directory) {
  std::error_code problem;
  for (const auto& entry : fs::directory_iterator(directory, problem)) {
    const std::string name = entry.path().filename().string();
    const bool known = name == kLockName ||
                       std::any_of(kSuffixes.begin(), kSuffixes.end(), [&](const char* suffix) {
                         return name == std::string(kJournalName) + suffix;
                       });
    if (!known) return false;
  }
  return !problem;
}

}  // namespace

core::Result<bool> clear_unstarted_run(const fs::path& directory) {
  const fs::path journal = directory / kJournalName;
  std::error_code problem;
  if (!fs::exists(directory, problem) && !problem) return true;
  if (!fs::is_directory(directory, problem)) return false;
  if (fs::is_empty(directory, problem) && !problem) return true;
  if (problem) {
    return core::fail(core::Code::kFile,
                      fmt::format("the run directory {} cannot be looked at: {}",
                                  directory.string(), system_reason(problem.value())),
                      directory.string());
  }
  if (!holds_only_a_beginning(directory)) return false;
  if (!fs::exists(journal, problem)) return true;
  TRY_DO(RunLock::take(directory));
  auto unstarted = is_unstarted(journal);
  if (!unstarted || !*unstarted) return unstarted;
  for (const char* suffix : kSuffixes) {
    if (fs::remove(journal.string() + suffix, problem); problem) {
      return core::fail(core::Code::kFile,
                        fmt::format("the unfinished journal {} cannot be removed: {}",
                                    journal.string(), system_reason(problem.value())),
                        journal.string());
    }
  }
  return true;
}

}  // namespace rondure::record
