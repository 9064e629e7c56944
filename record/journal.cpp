#include "record/journal.h"

#include <algorithm>
#include <cerrno>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>
#include <unistd.h>

#include "record/database.h"
#include "record/files.h"
#include "record/journal_rows.h"
#include "record/run_lock.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using soci::use;

/// Removes what create() made, last first, unless it succeeded.
struct Undo {
  std::vector<fs::path> made;

  Undo() = default;
  Undo(const Undo&) = delete;
  Undo& operator=(const Undo&) = delete;
  ~Undo() {
    std::error_code ignored;  // a folder that another program filled meanwhile stays
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

/// A lock is only made in an empty directory; where one lies, it says who is at work there.
core::Result<RunLock> lock_empty_directory(const fs::path& directory) {
  std::error_code ignored;
  if (!fs::exists(directory / kLockName, ignored)) {
    if (auto empty = require_empty_directory(directory); !empty) return core::fail(empty.error());
  }
  auto lock = RunLock::take(directory);
  if (!lock) return lock;
  if (auto empty = require_empty_directory(directory); !empty) return core::fail(empty.error());
  return lock;
}

/// Makes the empty file itself, so that two runs can never share one.
core::Result<void> make_file(const fs::path& file, Undo& undo) {
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

/// The new names reach the disk before the first touch does.
core::Result<void> sync_names(const Undo& undo) {
  for (const fs::path& path : undo.made) {
    if (auto synced = sync_directory(path.parent_path()); !synced) return synced;
  }
  return {};
}

/// Exclusive: no other program can hold up a touch. WAL and synchronous=full: one flush a commit,
/// on disk when the call returns.
void set_pragmas(soci::session& sql) {
  std::string mode;
  sql << "pragma locking_mode = exclusive", soci::into(mode);
  sql << "pragma journal_mode = wal", soci::into(mode);
  if (mode != "wal") throw std::runtime_error("SQLite refuses a write-ahead log (" + mode + ")");
  sql << "pragma synchronous = full";
}

/// Moves the write-ahead log into the file.
void fold_log(soci::session& sql) {
  int busy = 0;
  int frames = 0;
  int moved = 0;
  sql << "pragma wal_checkpoint(truncate)", soci::into(busy), soci::into(frames), soci::into(moved);
  if (busy != 0) throw std::runtime_error("another program reads it; close that program");
}

}  // namespace

struct Journal::Impl {
  enum class State { kOpen, kDigested, kClosed };

  RunLock lock;  ///< Before the session: given back after the journal is closed.
  fs::path file;
  soci::session sql;
  std::optional<Statements> statements;
  std::optional<std::int64_t> last_touch;
  bool ended = false;
  State state = State::kOpen;

  Impl(RunLock taken, fs::path path, const std::string& connection)
      : lock(std::move(taken)), file(std::move(path)), sql(soci::sqlite3, connection) {}

  /// Why `subject` is not in the journal, and what is safe.
  [[nodiscard]] tl::unexpected<core::Error> failure(std::string_view subject,
                                                    std::string_view reason) const {
    return core::fail(
        core::Code::kJournal,
        fmt::format("{} cannot be written to {}: {}{}", subject, file.string(), reason,
                    last_touch ? fmt::format("; the touches up to number {} are kept", *last_touch)
                               : std::string()));
  }

  /// Runs `action`, which writes `subject` in one transaction.
  template <class Action>
  core::Result<void> write(std::string_view subject, const Action& action) {
    if (state != State::kOpen) {
      return failure(subject, "the journal is sealed and takes nothing more; start a new run");
    }
    try {
      action();
      return {};
    } catch (const std::exception& exception) {
      return failure(subject, reason_of(exception, &sql));
    }
  }

  void insert(const Touch& touch) {
    statements->touch = touch;
    statements->purpose = name_of(touch.purpose);
    statements->insert_touch.execute(true);
  }

  void keep(const Touch& touch) {
    last_touch = last_touch ? std::max(*last_touch, touch.id) : touch.id;
  }
};

Journal::Journal(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

core::Result<Journal> Journal::create(const fs::path& directory, const Header& header,
                                      const Artefact& artefact, std::span<const Feature> features) {
  fs::path folder = fs::absolute(directory);
  if (!folder.has_filename()) folder = folder.parent_path();  // "runs/1/" is "runs/1"
  const fs::path file = folder / kJournalName;
  const auto connection = connection_string(file);
  if (!connection) return core::fail(connection.error());

  Undo undo;
  if (auto made = make_directory(folder, undo); !made) return core::fail(made.error());
  auto lock = lock_empty_directory(folder);
  if (!lock) return core::fail(lock.error());
  if (auto made = make_file(file, undo); !made) return core::fail(made.error());
  std::unique_ptr<Impl> impl;  // after `undo`: closes the file before it is removed
  try {
    impl = std::make_unique<Impl>(std::move(*lock), file, *connection);
    set_pragmas(impl->sql);
    insert_head(impl->sql, header, artefact, features);
    fold_log(impl->sql);
    impl->statements.emplace(impl->sql);
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the journal {} cannot be made: {}", file.string(),
                                  reason_of(exception, impl ? &impl->sql : nullptr)));
  }
  if (auto synced = sync_names(undo); !synced) return core::fail(synced.error());
  undo.made.clear();
  return Journal(std::move(impl));
}

core::Result<Journal> Journal::reopen(const fs::path& directory) {
  const fs::path file = fs::absolute(directory) / kJournalName;
  const auto connection = connection_string(file);
  if (!connection) return core::fail(connection.error());
  auto lock = RunLock::take(directory);
  if (!lock) return core::fail(lock.error());
  const auto found = read_journal(directory);
  if (!found) return core::fail(found.error());
  if (found->record.sealed) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the run in {} is finished and sealed; it takes nothing more",
                                  directory.string()),
                      file.string());
  }
  remove_temporaries(directory);
  std::unique_ptr<Impl> impl;
  try {
    impl = std::make_unique<Impl>(std::move(*lock), file, *connection);
    set_pragmas(impl->sql);
    impl->statements.emplace(impl->sql);
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the journal {} cannot be opened again: {}", file.string(),
                                  reason_of(exception, impl ? &impl->sql : nullptr)),
                      file.string());
  }
  for (const Touch& touch : found->record.touches) impl->keep(touch);
  if (!found->record.ending.empty()) {
    auto cleared = impl->write("that the run goes on", [&] {
      impl->sql << "update header set ending = '', failure_code = null, failure_what = null, "
                   "failure_where = null";
    });
    if (!cleared) return core::fail(cleared.error());
  }
  return Journal(std::move(impl));
}

core::Result<void> Journal::add(const Touch& touch) {
  auto written = impl_->write(fmt::format("touch {}", touch.id), [&] { impl_->insert(touch); });
  if (written) impl_->keep(touch);
  return written;
}

core::Result<void> Journal::add(std::span<const Touch> touches) {
  if (touches.empty()) return {};
  const std::string subject =
      fmt::format("touches {} to {}", touches.front().id, touches.back().id);
  auto written = impl_->write(subject, [&] {
    soci::transaction transaction(impl_->sql);
    for (const Touch& touch : touches) impl_->insert(touch);
    transaction.commit();
  });
  if (written) {
    for (const Touch& touch : touches) impl_->keep(touch);
  }
  return written;
}

core::Result<void> Journal::add(const PoseVisit& pose) {
  return impl_->write(fmt::format("pose {}", pose.id), [&] {
    impl_->statements->pose = pose;
    impl_->statements->final_cloud = pose.final_cloud ? 1 : 0;
    impl_->statements->insert_pose.execute(true);
  });
}

core::Result<void> Journal::add(const Decision& decision) {
  return impl_->write("a decision", [&] {
    impl_->statements->decision = decision;
    impl_->statements->insert_decision.execute(true);
  });
}

core::Result<void> Journal::add(const SimulationTruth& truth) {
  return impl_->write("the truth of the simulation", [&] {
    impl_->statements->truth = truth;
    impl_->statements->insert_truth.execute(true);
  });
}

core::Result<void> Journal::mark_final(int pose_id) {
  return impl_->write(fmt::format("the mark of the final pose {}", pose_id), [&] {
    impl_->statements->marked_pose = pose_id;
    impl_->statements->update_final.execute(true);
    if (impl_->statements->update_final.get_affected_rows() == 0) {
      throw std::runtime_error("there is no such pose");
    }
  });
}

core::Result<void> Journal::end(const std::string& ending, const core::Error* failure) {
  auto written = impl_->write("the ending of the run", [&] {
    if (impl_->ended) throw std::runtime_error("it stands there already");
    const std::string code = failure == nullptr ? "" : std::string(core::code_name(failure->code));
    const std::string what = failure == nullptr ? "" : failure->what;
    const std::string where = failure == nullptr ? "" : failure->where;
    soci::indicator given = failure == nullptr ? soci::i_null : soci::i_ok;
    impl_->sql << "update header set ending = :ending, failure_code = :code, failure_what = :what, "
                  "failure_where = :place",
        use(ending), use(code, given), use(what, given), use(where, given);
  });
  impl_->ended = impl_->ended || written.has_value();
  return written;
}

core::Result<void> Journal::seal(std::span<const StoredResult> results) {
  Impl& impl = *impl_;
  if (impl.state == Impl::State::kOpen) {
    auto written = impl.write("the seal", [&] {
      soci::transaction transaction(impl.sql);
      insert_results(impl.sql, results);
      insert_digests(impl.sql);
      transaction.commit();
    });
    if (!written) return written;
    impl.state = Impl::State::kDigested;
  }
  if (impl.state == Impl::State::kClosed) {
    return impl.failure("the seal", "it stands there already");
  }
  try {
    fold_log(impl.sql);
    impl.statements.reset();
    std::string mode;
    impl.sql << "pragma journal_mode = delete", soci::into(mode);
    impl.sql.close();
    impl.state = Impl::State::kClosed;
    return {};
  } catch (const std::exception& exception) {  // the digests are safe; a second call folds again
    return impl.failure("the folded log", reason_of(exception, &impl.sql));
  }
}

}  // namespace rondure::record
