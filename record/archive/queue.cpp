#include "record/archive/queue.h"

#include <chrono>
#include <system_error>
#include <thread>
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

namespace {

using Clock = std::chrono::steady_clock;

/// The time limits of one delivery.
class RetryPolicy {
 public:
  explicit RetryPolicy(const DeliveryOptions& options) : options_(options) {}

  [[nodiscard]] bool ended() const {
    const std::chrono::duration<double> passed = Clock::now() - start_;
    return passed.count() > options_.give_up_after_s ||
           (options_.stop_requested && options_.stop_requested());
  }
  /// Waits before attempt `number` (from 0); false when no more attempts are allowed.
  [[nodiscard]] bool allows(int number) const {
    if (number == 0) return true;
    if (number >= options_.attempts || ended()) return false;
    std::this_thread::sleep_for(std::chrono::duration<double>(options_.pause_s) *
                                (1 << (number - 1)));
    return !ended();
  }

 private:
  const DeliveryOptions& options_;
  Clock::time_point start_ = Clock::now();
};

/// An archive that is reopened after a fault.
class Receiver {
 public:
  Receiver(const ArchivePlace& place, const RetryPolicy& retries)
      : place_(place), retries_(retries) {}

  core::Result<bool> push(const ArchiveRun& run) {
    core::Result<bool> pushed = false;
    for (int attempt = 0; retries_.allows(attempt); ++attempt) {
      pushed = push_once(run);
      // Only a fault that may be temporary is worth another attempt.
      if (pushed || pushed.error().code != core::Code::kArchive) return pushed;
      archive_.reset();
    }
    return pushed;
  }

 private:
  core::Result<bool> push_once(const ArchiveRun& run) {
    if (!archive_) {
      TRY(auto opened, Archive::open(place_, Archive::Access::kWrite));
      archive_.emplace(std::move(opened));
    }
    return archive_->push(run);
  }

  const ArchivePlace& place_;
  const RetryPolicy& retries_;
  std::optional<Archive> archive_;
};

void count(Delivery& delivery, const ArchiveRun& run, bool added) {
  if (!added) return;
  ++delivery.sent;
  delivery.results += run.results.size();
}

core::Result<void> send_queue(ArchiveQueue& queue, const std::string& target, Receiver& receiver,
                              const RetryPolicy& retries, Delivery& delivery) {
  while (!delivery.failure && !retries.ended()) {
    TRY(const auto waiting, queue.first(target));
    if (!waiting) return {};
    const auto pushed = receiver.push(*waiting);
    if (!pushed) {
      delivery.failure = pushed.error();
      return {};
    }
    count(delivery, *waiting, *pushed);
    if (auto removed = queue.remove(target, *waiting); !removed) return removed;
  }
  return {};
}

core::Result<void> use_queue(const std::filesystem::path& file, const std::string& target,
                             const ArchiveRun* left, Receiver& receiver, const RetryPolicy& retries,
                             Delivery& delivery) {
  TRY(auto queue, ArchiveQueue::open(file));
  if (left != nullptr) {
    if (auto added = queue.add(target, *left); !added) return added;
  } else if (auto sent = send_queue(queue, target, receiver, retries, delivery); !sent) {
    return sent;
  }
  TRY(delivery.waiting, queue.size(target));
  return {};
}

}  // namespace

Delivery deliver(const ArchivePlace& place, const std::filesystem::path& queue_file,
                 const ArchiveRun* run, const DeliveryOptions& options) {
  Delivery delivery;
  const RetryPolicy retries(options);
  Receiver receiver(place, retries);
  const ArchiveRun* left = nullptr;
  if (run != nullptr) {
    if (const auto pushed = receiver.push(*run)) {
      count(delivery, *run, *pushed);
      delivery.known = !*pushed;
    } else {
      delivery.failure = pushed.error();
      if (pushed.error().code == core::Code::kBadOption)
        return delivery;  // no archive accepts this run
      left = run;
    }
  }
  std::error_code unknown;
  if (left == nullptr && !std::filesystem::exists(queue_file, unknown)) return delivery;
  auto queued = use_queue(queue_file, place.key, left, receiver, retries, delivery);
  if (!queued) delivery.queue_failure = queued.error();
  return delivery;
}

}  // namespace rondure::record
