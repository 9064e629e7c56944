#include "record/journal.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include "record/chain.h"
#include "record/checksums.h"
#include "record/database.h"
#include "record/files.h"
#include "record/journal_place.h"
#include "record/journal_rows.h"
#include "record/journal_schema.h"
#include "record/journal_seal.h"
#include "record/run_lock.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;
using soci::use;

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

/// From then on the journal is one file.
void leave_log(soci::session& sql) {
  std::string mode;
  sql << "pragma journal_mode = delete", soci::into(mode);
}

/// Puts the digest of the closed journal into the list beside it.
core::Result<void> list_digest(const fs::path& file) {
  const auto bytes = read_file(file);
  if (!bytes) return core::fail(bytes.error());
  return update_checksums(file.parent_path(), {{kJournalName, sha256_hex(*bytes)}});
}

/// Why a journal takes nothing more, or empty.
std::string why_not_to_go_on(const ReadJournal& journal) {
  if (journal.record.sealed) return "the run is finished and its journal is sealed";
  if (journal.version != kSchemaVersion) {
    return fmt::format(
        "its tables have version {}, a run goes on in version {} only; start a new "
        "run",
        journal.version, kSchemaVersion);
  }
  if (journal.broken.empty()) return {};
  return fmt::format("table {} of its journal was changed: {}; start a new run",
                     journal.broken.front().table, journal.broken.front().what);
}

}  // namespace

struct Journal::Impl {
  enum class State { kOpen, kDigested, kFolded, kClosed };

  RunLock lock;  ///< Before the session: given back after the journal is closed.
  fs::path file;
  soci::session sql;
  std::optional<Statements> statements;
  std::optional<Chain> chain;
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
      soci::transaction transaction(sql);
      action();
      transaction.commit();
      chain->keep();
      return {};
    } catch (const std::exception& exception) {
      chain->forget();
      return failure(subject, reason_of(exception, &sql));
    }
  }

  /// Prepares what runs during a measurement.
  void prepare() {
    statements.emplace(sql);
    chain.emplace(sql);
  }

  void insert(const Touch& touch) {
    statements->touch = touch;
    statements->purpose = name_of(touch.purpose);
    statements->insert_touch.execute(true);
    chain->append("touch", touch.id);
  }

  void clear_ending() {
    sql << "update header set ending = '', failure_code = null, failure_what = null, "
           "failure_where = null";
    chain->append("header", 0);
  }

  /// Makes one closed file of the journal and its log.
  core::Result<void> fold() {
    try {
      fold_log(sql);
      statements.reset();
      chain.reset();
      leave_log(sql);
      sql.close();
      state = State::kFolded;
      return {};
    } catch (const std::exception& exception) {  // the digests are safe
      return failure("the folded log", reason_of(exception, &sql));
    }
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
  auto lock = lock_new_directory(folder, undo);
  if (!lock) return core::fail(lock.error());
  if (auto made = make_empty_journal(file, undo); !made) return core::fail(made.error());
  std::unique_ptr<Impl> impl;  // after `undo`: closes the file before it is removed
  try {
    impl = std::make_unique<Impl>(std::move(*lock), file, *connection);
    set_pragmas(impl->sql);
    insert_head(impl->sql, header, artefact, features);
    fold_log(impl->sql);
    impl->prepare();
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
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return core::fail(read_journal(directory).error());
  auto lock = RunLock::take(directory);
  if (!lock) return core::fail(lock.error());
  const auto found = read_journal(directory);
  if (!found) return core::fail(found.error());
  if (const std::string reason = why_not_to_go_on(*found); !reason.empty()) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the run cannot go on in {}: {}", file.string(), reason),
                      file.string());
  }
  const auto connection = connection_string(file);
  if (!connection) return core::fail(connection.error());
  remove_temporaries(directory);
  std::unique_ptr<Impl> impl;
  try {
    impl = std::make_unique<Impl>(std::move(*lock), file, *connection);
    int timeout_ms = 0;
    impl->sql << "pragma busy_timeout = 0", soci::into(timeout_ms);  // a run holds it for hours
    set_pragmas(impl->sql);
    impl->prepare();
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the journal {} cannot be opened again: {}", file.string(),
                                  reason_of(exception, impl ? &impl->sql : nullptr)),
                      file.string());
  }
  for (const Touch& touch : found->record.touches) impl->keep(touch);
  if (!found->record.ending.empty()) {
    if (auto cleared = impl->write("that the run goes on", [&] { impl->clear_ending(); });
        !cleared) {
      return core::fail(cleared.error());
    }
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
    for (const Touch& touch : touches) impl_->insert(touch);
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
    impl_->chain->append("pose", pose.id);
  });
}

core::Result<void> Journal::add(const Decision& decision) {
  return impl_->write("a decision", [&] {
    impl_->statements->decision = decision;
    impl_->statements->insert_decision.execute(true);
    impl_->chain->append_inserted("decision");
  });
}

core::Result<void> Journal::add(const SimulationTruth& truth) {
  return impl_->write("the truth of the simulation", [&] {
    impl_->statements->truth = truth;
    impl_->statements->insert_truth.execute(true);
    impl_->chain->append_inserted("truth");
  });
}

core::Result<void> Journal::mark_final(int pose_id) {
  return impl_->write(fmt::format("the mark of the final pose {}", pose_id), [&] {
    impl_->statements->marked_pose = pose_id;
    impl_->statements->update_final.execute(true);
    if (impl_->statements->update_final.get_affected_rows() == 0) {
      throw std::runtime_error("there is no such pose");
    }
    impl_->chain->append("pose", pose_id);
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
    impl_->chain->append("header", 0);
  });
  impl_->ended = impl_->ended || written.has_value();
  return written;
}

core::Result<void> Journal::seal(std::span<const StoredResult> results) {
  Impl& impl = *impl_;
  if (impl.state == Impl::State::kOpen) {
    auto written = impl.write("the seal", [&] {
      insert_results(impl.sql, results);
      impl.chain->append_all("result");
      insert_seal(impl.sql);
    });
    if (!written) return written;
    impl.state = Impl::State::kDigested;
  }
  if (impl.state == Impl::State::kClosed) {
    return impl.failure("the seal", "it stands there already");
  }
  if (impl.state == Impl::State::kDigested) {
    if (auto folded = impl.fold(); !folded) return folded;
  }
  auto listed = list_digest(impl.file);
  if (listed) impl.state = Impl::State::kClosed;
  return listed;
}

core::Result<void> Journal::finish_seal(const fs::path& directory) {
  const fs::path file = fs::absolute(directory) / kJournalName;
  std::error_code ignored;
  if (fs::exists(directory / kChecksumsName, ignored)) {
    const auto listed = read_checksums(directory);
    if (!listed) return core::fail(listed.error());
    const bool known = std::any_of(listed->begin(), listed->end(),
                                   [](const Checksum& line) { return line.file == kJournalName; });
    if (known) return {};
  }
  const auto connection = connection_string(file);
  if (!connection) return core::fail(connection.error());
  std::optional<soci::session> sql;
  try {
    sql.emplace(soci::sqlite3, *connection);
    fold_log(*sql);
    leave_log(*sql);
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the log of {} cannot be folded: {}", file.string(),
                                  reason_of(exception, sql ? &*sql : nullptr)),
                      file.string());
  }
  return list_digest(file);
}

}  // namespace rondure::record
