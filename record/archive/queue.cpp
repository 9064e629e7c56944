#include "record/archive/queue.h"

#include <utility>

#include <soci/soci.h>

#include "record/archive/internal/rows.h"
#include "record/archive/internal/session.h"

namespace rondure::record {

using soci::into;
using soci::use;

struct ArchiveQueue::Impl {
  std::unique_ptr<ArchiveSession> session;

  [[nodiscard]] soci::session& sql() const { return session->sql; }

  /// Runs `read` and returns its result.
  template <class T, class Read>
  core::Result<T> answer(const Read& read) {
    try {
      return read();
    } catch (const std::exception& exception) {
      return archive_failure(session->place, "read", exception, &session->sql);
    }
  }
};

ArchiveQueue::ArchiveQueue(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ArchiveQueue::ArchiveQueue(ArchiveQueue&&) noexcept = default;
ArchiveQueue& ArchiveQueue::operator=(ArchiveQueue&&) noexcept = default;
ArchiveQueue::~ArchiveQueue() = default;

core::Result<ArchiveQueue> ArchiveQueue::open(const std::filesystem::path& file) {
  const std::string path = file.string();
  const ArchivePlace place{ArchivePlace::Kind::kFile, path, path, path};
  auto session = open_archive_session(place, Archive::Access::kWrite);
  if (!session) return core::fail(session.error());
  auto impl = std::make_unique<Impl>(Impl{std::move(*session)});
  auto made = write_in_one(*impl->session, [&] {
    impl->sql() << "create table if not exists rondure_queue (id integer primary key, "
                   "journal_sha256 text not null, target text not null, unique (journal_sha256, "
                   "target))";
  });
  if (!made) return core::fail(made.error());
  return ArchiveQueue(std::move(impl));
}

core::Result<void> ArchiveQueue::add(const std::string& target, const ArchiveRun& run) {
  return write_in_one(*impl_->session, [&] {
    insert_run(impl_->sql(), run, seconds_of_utc(run.head.started_utc).value_or(0));
    impl_->sql() << "insert into rondure_queue (journal_sha256, target) values (:journal, :target) "
                    "on conflict do nothing",
        use(run.head.journal_sha256), use(target);
  });
}

core::Result<std::vector<std::string>> ArchiveQueue::targets() {
  return impl_->answer<std::vector<std::string>>([&] {
    const soci::rowset<std::string> rows =
        (impl_->sql().prepare
         << "select target from rondure_queue group by target order by min(id)");
    return std::vector<std::string>(rows.begin(), rows.end());
  });
}

core::Result<std::size_t> ArchiveQueue::size(const std::string& target) {
  return impl_->answer<std::size_t>([&] {
    long long count = 0;
    impl_->sql() << "select count(*) from rondure_queue where target = :target", into(count),
        use(target);
    return static_cast<std::size_t>(count);
  });
}

core::Result<std::optional<ArchiveRun>> ArchiveQueue::first(const std::string& target) {
  return impl_->answer<std::optional<ArchiveRun>>([&]() -> std::optional<ArchiveRun> {
    std::string journal;
    impl_->sql() << "select journal_sha256 from rondure_queue where target = :target order by id "
                    "limit 1",
        into(journal), use(target);
    if (!impl_->sql().got_data()) return std::nullopt;
    return select_run(impl_->sql(), journal);
  });
}

core::Result<void> ArchiveQueue::remove(const std::string& target, const ArchiveRun& run) {
  const std::string& journal = run.head.journal_sha256;
  return write_in_one(*impl_->session, [&] {
    soci::session& sql = impl_->sql();
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
