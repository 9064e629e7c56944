#include "record/archive/queue.h"

#include <utility>

#include <soci/soci.h>

#include "record/archive/internal/rows.h"
#include "record/archive/internal/session.h"

namespace rondure::record {

using soci::into;
using soci::use;

ArchiveQueue::ArchiveQueue(std::unique_ptr<ArchiveSession> session)
    : session_(std::move(session)) {}
ArchiveQueue::ArchiveQueue(ArchiveQueue&&) noexcept = default;
ArchiveQueue& ArchiveQueue::operator=(ArchiveQueue&&) noexcept = default;
ArchiveQueue::~ArchiveQueue() = default;

core::Result<ArchiveQueue> ArchiveQueue::open(const std::filesystem::path& file) {
  const std::string path = file.string();
  const ArchivePlace place{ArchivePlace::Kind::kFile, path, path, path};
  TRY(auto session, open_archive_session(place, Archive::Access::kWrite));
  TRY_DO(write_in_one(*session, [&] {
    session->sql << "create table if not exists rondure_queue (id integer primary key, "
                    "journal_sha256 text not null, target text not null, unique (journal_sha256, "
                    "target))";
  }));
  return ArchiveQueue(std::move(session));
}

core::Result<void> ArchiveQueue::add(const std::string& target, const ArchiveRun& run) {
  return write_in_one(*session_, [&] {
    insert_run(session_->sql, run, seconds_of_utc(run.head.started_utc).value_or(0));
    session_->sql
        << "insert into rondure_queue (journal_sha256, target) values (:journal, :target) "
           "on conflict do nothing",
        use(run.head.journal_sha256), use(target);
  });
}

core::Result<std::vector<std::string>> ArchiveQueue::targets() {
  return read_from<std::vector<std::string>>(
      *session_, [&] {
        const soci::rowset<std::string> rows =
            (session_->sql.prepare
             << "select target from rondure_queue group by target order by min(id)");
        return std::vector<std::string>(rows.begin(), rows.end());
      });
}

core::Result<std::size_t> ArchiveQueue::size(const std::string& target) {
  return read_from<std::size_t>(*session_, [&] {
    long long count = 0;
    session_->sql << "select count(*) from rondure_queue where target = :target", into(count),
        use(target);
    return static_cast<std::size_t>(count);
  });
}

core::Result<std::optional<ArchiveRun>> ArchiveQueue::first(const std::string& target) {
  return read_from<std::optional<ArchiveRun>>(*session_, [&]() -> std::optional<ArchiveRun> {
    std::string journal;
    session_->sql << "select journal_sha256 from rondure_queue where target = :target order by id "
                     "limit 1",
        into(journal), use(target);
    if (!session_->sql.got_data()) return std::nullopt;
    return select_run(session_->sql, journal);
  });
}

core::Result<void> ArchiveQueue::remove(const std::string& target, const ArchiveRun& run) {
  const std::string& journal = run.head.journal_sha256;
  return write_in_one(*session_, [&] {
    soci::session& sql = session_->sql;
    sql << "delete from rondure_queue where journal_sha256 = :journal and target = :target",
        use(journal), use(target);
    // The run may still be queued for another archive.
    sql << "delete from rondure_result where run in (select id from rondure_run where "
           "journal_sha256 = :journal) and not exists (select 1 from rondure_queue where "
           "journal_sha256 = :again)",
        use(journal), use(journal);
    sql << "delete from rondure_run where journal_sha256 = :journal and not exists (select 1 from "
           "rondure_queue where journal_sha256 = :again)",
        use(journal), use(journal);
  });
}

}  // namespace rondure::record
