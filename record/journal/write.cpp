#include "record/journal/journal.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "record/checksums.h"
#include "record/files.h"
#include "record/growing_record.h"
#include "record/journal/internal/impl.h"
#include "record/journal/internal/series.h"
#include "record/sha256.h"

namespace rondure::record {
namespace {

namespace fs = std::filesystem;

/// Writes the digest of the closed journal into the list in its directory.
core::Result<void> list_digest(const fs::path& file) {
  TRY(auto sha256, sha256_inside(file.parent_path(), kJournalName));
  return update_checksums(file.parent_path(), {{kJournalName, std::move(sha256)}});
}

}  // namespace

using soci::use;

Journal::Journal(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Journal::Journal(Journal&&) noexcept = default;
Journal& Journal::operator=(Journal&&) noexcept = default;
Journal::~Journal() = default;

void Journal::follow(std::shared_ptr<GrowingRecord> copy) { impl_->follower = std::move(copy); }

core::Result<void> Journal::add(const Touch& touch) {
  const bool check = touch.purpose == Touch::Purpose::kCheck;
  const std::string subject =
      check ? std::string("a repeated touch") : fmt::format("touch {}", touch.id);
  auto written = impl_->write(subject, [&] { impl_->insert(touch); });
  if (written) impl_->note_touch(touch);
  if (written && impl_->follower) impl_->follower->add(std::span(&touch, 1));
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
    for (const Touch& touch : touches) impl_->note_touch(touch);
    if (impl_->follower) impl_->follower->add(touches);
  }
  return written;
}

core::Result<void> Journal::add(const PoseVisit& pose) {
  auto written = impl_->write(fmt::format("pose {}", pose.id), [&] {
    impl_->statements->pose = pose;
    impl_->statements->final_cloud = pose.final_cloud ? 1 : 0;
    impl_->statements->insert_pose.execute(true);
    impl_->link(pose);
  });
  if (written) impl_->poses.insert_or_assign(pose.id, pose);
  if (written && impl_->follower) impl_->follower->add(pose);
  return written;
}

core::Result<void> Journal::add(const Decision& decision) {
  auto written = impl_->write("a decision", [&] { impl_->insert(decision); });
  if (written && impl_->follower) impl_->follower->add(decision);
  return written;
}

core::Result<void> Journal::add(std::span<const Series> series,
                                std::span<const TruthValue> truths) {
  if (series.empty() && truths.empty()) return {};
  const std::string subject = series.empty()
                                  ? std::string("the truth of the simulation")
                                  : fmt::format("the series of feature {}", series.front().feature);
  return impl_->write(subject, [&] { insert_series(impl_->sql, *impl_->chain, series, truths); });
}

core::Result<void> Journal::mark_final(int pose_id) {
  auto written = impl_->write(fmt::format("the mark of the final pose {}", pose_id), [&] {
    const auto pose = impl_->poses.find(pose_id);
    if (pose == impl_->poses.end()) throw std::runtime_error("there is no such pose");
    impl_->statements->marked_pose = pose_id;
    impl_->statements->update_final.execute(true);
    PoseVisit marked = pose->second;
    marked.final_cloud = true;
    impl_->link(marked);
  });
  if (written) impl_->poses.at(pose_id).final_cloud = true;
  if (written && impl_->follower) impl_->follower->mark_final(pose_id);
  return written;
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
    impl_->link_header(ending, failure);
  });
  impl_->ended = impl_->ended || written.has_value();
  if (written && impl_->follower) impl_->follower->end(ending, failure);
  return written;
}

core::Result<void> Journal::seal(std::span<const StoredResult> results) {
  Impl& impl = *impl_;
  if (impl.state == Impl::State::kOpen) {
    auto written = impl.write("the seal", [&] {
      insert_results(impl.sql, *impl.chain, results);
      insert_seal(impl.sql);
    });
    if (!written) return written;
    impl.state = Impl::State::kDigested;
  }
  if (impl.state == Impl::State::kClosed) {
    return impl.failure("the seal", "it stands there already");
  }
  if (impl.state == Impl::State::kDigested) {
    if (auto moved = impl.leave_wal(); !moved) return moved;
  }
  auto listed = list_digest(impl.file);
  if (listed) impl.state = Impl::State::kClosed;
  return listed;
}

core::Result<void> Journal::finish_seal(const fs::path& directory) {
  const fs::path file = fs::absolute(directory) / kJournalName;
  std::error_code ignored;
  if (fs::exists(directory / kChecksumsName, ignored)) {
    TRY(const auto listed, read_checksums(directory));
    const bool known = std::any_of(listed.begin(), listed.end(),
                                   [](const Checksum& line) { return line.file == kJournalName; });
    if (known) return {};
  }
  if (auto own = require_no_link(file); !own) return own;
  TRY(const auto connection, connection_string(file));
  std::optional<soci::session> sql;
  try {
    sql.emplace(soci::sqlite3, connection);
    distrust(*sql);
    int tables = 0;  // this read rolls back an unfinished change of the mode
    *sql << "select count(*) from sqlite_schema", soci::into(tables);
    checkpoint_wal(*sql);
    disable_wal(*sql);
  } catch (const std::exception& exception) {
    return core::fail(core::Code::kJournal,
                      fmt::format("the log of {} cannot be folded: {}", file.string(),
                                  reason_of(exception, sql ? &*sql : nullptr)),
                      file.string());
  }
  sql.reset();
  // Left by a process that died in disable_wal(): SQLite has rolled back or finished its contents,
  // but keeps the file.
  fs::remove(file.string() + "-journal", ignored);
  return list_digest(file);
}

}  // namespace rondure::record
