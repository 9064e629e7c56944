#include "record/journal/journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "record/checksums.h"
#include "record/files.h"
#include "record/journal/internal/impl.h"
#include "record/journal/internal/private_copy.h"
#include "record/journal/internal/reader.h"
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

namespace {

namespace fs = std::filesystem;

/// Removes the files and folders created for a journal, last first, unless `made` is cleared.
struct Undo {
  std::vector<fs::path> made;

  Undo() = default;
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;
  ~Undo() {
    std::error_code ignored;  // a folder that another program has filled is kept
    for (auto path = made.rbegin(); path != made.rend(); ++path) fs::remove(*path, ignored);
  }
};

core::Result<void> make_directory(const fs::path& directory, Undo& undo) {
  std::vector<fs::path> missing;
  std::error_code problem;
  for (fs::path path = directory;
       !fs::exists(path, problem) && !problem && path.has_relative_path();
       path = path.parent_path()) {
    missing.push_back(path);
  }
  for (auto path = missing.rbegin(); path != missing.rend() && !problem; ++path) {
    if (fs::create_directory(*path, problem)) undo.made.push_back(*path);
  }
  if (problem) {
    return core::fail(core::Code::kFile,
                      fmt::format("the run directory {} cannot be made: {}", directory.string(),
                                  system_reason(problem.value())),
                      directory.string());
  }
  return {};
}

core::Result<void> require_empty_directory(const fs::path& directory) {
  std::error_code problem;
  fs::directory_iterator entry(directory, problem);
  if (problem) {
    return core::fail(
        core::Code::kFile,
        problem.value() == ENOTDIR
            ? fmt::format("{} is a file; name a new directory for this run", directory.string())
            : fmt::format("the run directory {} cannot be looked at: {}", directory.string(),
                          system_reason(problem.value())),
        directory.string());
  }
  const fs::directory_iterator end;
  if (entry != end && entry->path().filename() == kLockName) entry.increment(problem);
  if (entry == end) return {};
  return core::fail(core::Code::kFile,
                    fmt::format("{} is not empty (it holds {}); name a new directory for this run",
                                directory.string(), entry->path().filename().string()),
                    directory.string());
}

/// Creates a directory where it is missing and takes its lock. kFile when that fails, when another
/// process holds the lock, or when the directory holds anything else; nothing is written then.
core::Result<RunLock> lock_new_directory(const fs::path& directory, Undo& undo) {
  TRY_DO(make_directory(directory, undo));
  // A new lock is created only in an empty directory; an existing one names its holder.
  std::error_code ignored;
  if (!fs::exists(directory / kLockName, ignored)) {
    TRY_DO(require_empty_directory(directory));
  }
  auto lock = RunLock::take(directory);
  if (!lock) return lock;
  TRY_DO(require_empty_directory(directory));
  return lock;
}

/// Creates the empty file of a journal exclusively, so that two runs never share one; kFile.
core::Result<void> make_empty_journal(const fs::path& file, Undo& undo) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (fd < 0) {
    return core::fail(
        core::Code::kFile,
        fmt::format("the journal {} cannot be made: {}", file.string(), system_reason(errno)),
        file.string());
  }
  ::close(fd);
  for (const char* suffix : {"-shm", "-wal", "-journal", ""}) {
    undo.made.emplace_back(file.string() + suffix);
  }
  return {};
}

/// Flushes the new directory entries to disk before the first touch is written; kFile.
core::Result<void> sync_names(const Undo& undo) {
  for (const fs::path& path : undo.made) {
    if (auto synced = sync_directory(path.parent_path()); !synced) return synced;
  }
  return {};
}

/// The reason why a journal accepts no more rows, or empty.
std::string why_not_to_go_on(const ReadJournal& journal) {
  if (journal.record.sealed) return "the run is finished and its journal is sealed";
  if (journal.listed) {
    return fmt::format(
        "{} names {}, as of a run that is finished; take its line out if the run "
        "was interrupted",
        kChecksumsName, kJournalName);
  }
  if (journal.broken.empty()) return {};
  return fmt::format("table {} of its journal was changed: {}; start a new run",
                     journal.broken.front().table, journal.broken.front().what);
}

}  // namespace

core::Result<void> require_no_link(const fs::path& journal) {
  std::error_code ignored;
  if (!fs::is_symlink(journal, ignored)) return {};
  return core::fail(
      core::Code::kFile,
      fmt::format("{} is a link; a run goes on only where its journal stands", journal.string()),
      journal.string());
}

core::Result<Journal> Journal::create(const fs::path& directory, const Header& header,
                                      const Artefact& artefact, std::span<const Feature> features,
                                      std::span<const Setting> settings) {
  fs::path folder = fs::absolute(directory);
  if (!folder.has_filename()) folder = folder.parent_path();  // "runs/1/" is "runs/1"
  const fs::path file = folder / kJournalName;
  TRY(const auto connection, connection_string(file));

  Undo undo;
  TRY(auto lock, lock_new_directory(folder, undo));
  TRY_DO(make_empty_journal(file, undo));
  std::unique_ptr<Impl> impl;  // after `undo`: closes the file before it is removed
  try {
    impl = std::make_unique<Impl>(std::move(lock), file, connection);
    enable_wal(impl->sql);
    insert_head(impl->sql, header, artefact, features, settings);
    checkpoint_wal(impl->sql);
    impl->prepare();
    impl->header = header;
  } catch (const std::exception& exception) {
    return core::fail_with(core::Code::kJournal, "the journal {} cannot be made: {}", file.string(),
                           reason_of(exception, impl ? &impl->sql : nullptr));
  }
  TRY_DO(sync_names(undo));
  undo.made.clear();
  return Journal(std::move(impl));
}

core::Result<HeldJournal> hold_journal(const fs::path& directory) {
  std::error_code ignored;
  if (!fs::exists(directory / kJournalName, ignored)) {
    return core::fail(read_journal(directory).error());
  }
  TRY(auto lock, RunLock::take(directory));
  TRY(auto read, read_journal(directory));
  return HeldJournal{std::move(lock), std::move(read)};
}

core::Result<Journal> Journal::reopen(const fs::path& directory, HeldJournal held) {
  const fs::path file = fs::absolute(directory) / kJournalName;
  const ReadJournal& found = held.read;
  if (const std::string reason = why_not_to_go_on(found); !reason.empty()) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the run cannot go on in {}: {}", file.string(), reason),
                      file.string());
  }
  TRY_DO(require_no_link(file));
  TRY(const auto connection, connection_string(file));
  remove_temporaries(directory);
  std::unique_ptr<Impl> impl;
  try {
    impl = std::make_unique<Impl>(std::move(held.lock), file, connection);
    int timeout_ms = 0;
    // do not wait: a run holds the lock for hours
    impl->sql << "pragma busy_timeout = 0", soci::into(timeout_ms);
    enable_wal(impl->sql);
    require_schema(impl->sql);  // checked on the file itself, under our lock
    impl->prepare();
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the journal {} cannot be opened again: {}", file.string(),
                                  reason_of(exception, impl ? &impl->sql : nullptr)),
                      file.string());
  }
  impl->header = found.record.header;
  for (const PoseVisit& pose : found.record.poses) impl->poses.emplace(pose.id, pose);
  for (const Touch& touch : found.record.touches) impl->note_touch(touch);
  if (!found.record.ending.empty()) {
    TRY_DO(impl->write("that the run goes on", [&] { impl->clear_ending(); }));
  }
  return Journal(std::move(impl));
}

}  // namespace rondure::record
