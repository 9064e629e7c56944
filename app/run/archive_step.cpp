#include "app/run/archive_step.h"

#include <cstdio>

#include <fmt/format.h>

#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "record/archive/queue.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "record/sha256.h"
#include "reports/history/archive_entry.h"
#include "reports/history/earlier_results.h"
#include "reports/words/language.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

void tell_delivery(const record::ArchivePlace& place, const fs::path& directory,
                   const fs::path& queue, const record::Delivery& delivery, bool quiet) {
  if (delivery.failure) print_error(*delivery.failure);
  if (delivery.queue_failure) {
    print_error(*delivery.queue_failure);
    tell(fmt::format("rondure: the run is kept; archive it later: rondure history {} --add {}\n",
                     quoted(place.shown), quoted(directory.string())));
  } else if (delivery.waiting > 0) {
    tell(fmt::format(
        "rondure: the run is kept; {} in {} for the archive, and {} with the next run "
        "or now: rondure history {} --push --queue {}\n",
        reports::count(delivery.waiting, "run waits", "runs wait"), queue.string(),
        delivery.waiting == 1 ? "goes" : "go", quoted(place.shown), quoted(queue.string())));
  } else if (delivery.sent > 0 && !quiet) {
    say_line(fmt::format("Archived in {}", place.shown));
  }
}

}  // namespace

core::Result<record::ArchivePlace> archive_of(const std::string& argument, const plans::Plan& plan,
                                              const fs::path& directory) {
  if (!argument.empty()) return record::parse_archive_place(argument);
  const std::string& planned = plan.reports.archive;
  if (!planned.empty()) return record::parse_archive_place(planned, plan.folder);
  return record::parse_archive_place(record::kArchiveName, record::folder_beside(directory));
}

core::Result<record::ArchiveRun> entry_of(const fs::path& directory,
                                          const record::RunRecord& record,
                                          const evaluation::Evaluation& evaluation) {
  TRY(auto sha256, record::sha256_inside(directory, record::kJournalName));
  return reports::archive_entry(record, evaluation, std::move(sha256));
}

void keep_earlier_results(const record::ArchivePlace& place, const fs::path& directory,
                          const record::RunRecord& record) {
  std::error_code ignored;
  if (place.kind == record::ArchivePlace::Kind::kNone) return;
  if (fs::exists(directory / reports::kEarlierName, ignored)) return;
  auto archive = record::Archive::open(place, record::Archive::Access::kRead);
  if (!archive) return;
  record::ArchiveFilter filter;
  filter.part = record.header.part_id;
  filter.until_s = record::seconds_of_utc(record.header.started_utc);
  auto earlier = archive->newest(filter, reports::kMostEarlier);
  if (!earlier) return;
  std::erase_if(*earlier, [&](const record::ArchivedResult& r) {
    return r.head.run_id == record.header.run_id && r.head.started_utc == record.header.started_utc;
  });
  if (const auto kept = reports::keep_earlier(directory, *earlier); !kept)
    print_error(kept.error());
}

bool archive_run(const record::ArchivePlace& place, const fs::path& directory,
                 const record::RunRecord& record, const evaluation::Evaluation& evaluation,
                 bool quiet) {
  if (place.kind == record::ArchivePlace::Kind::kNone) return false;
  std::fflush(stdout);  // shows the result while a server is slow to answer
  const auto entry = entry_of(directory, record, evaluation);
  if (!entry) {
    print_error(entry.error());
    return true;
  }
  const fs::path queue = record::folder_beside(directory) / record::kArchiveQueueName;
  record::DeliveryOptions options;
  options.stop_requested = stop_requested;
  const auto delivery = record::deliver(place, queue, &*entry, options);
  tell_delivery(place, directory, queue, delivery, quiet);
  return !delivery.known;
}

}  // namespace rondure::app
