#include "record/archive/archive.h"

#include <charconv>
#include <chrono>
#include <utility>

#include <soci/soci.h>

#include "record/archive/internal/rows.h"
#include "record/archive/internal/session.h"

namespace rondure::record {

Archive::Archive(std::unique_ptr<ArchiveSession> session) : session_(std::move(session)) {}
Archive::Archive(Archive&&) noexcept = default;
Archive& Archive::operator=(Archive&&) noexcept = default;
Archive::~Archive() = default;

core::Result<Archive> Archive::open(const ArchivePlace& place, Access access) {
  TRY(auto session, open_archive_session(place, access));
  return Archive(std::move(session));
}

core::Result<bool> Archive::push(const ArchiveRun& run) {
  const auto time_s = seconds_of_utc(run.head.started_utc);
  if (!time_s) {
    return core::fail_with(
        core::Code::kBadOption,
        "the start of run {} is {}, not a time such as 2026-11-21T02:33:02Z; it cannot be archived",
        run.head.run_id, run.head.started_utc);
  }
  bool added = false;
  TRY_DO(write_in_one(*session_, [&] { added = insert_run(session_->sql, run, *time_s); }));
  return added;
}

core::Result<std::vector<ArchivedResult>> Archive::newest(const ArchiveFilter& filter,
                                                          std::size_t count,
                                                          const ArchivedResult* before) {
  return read_from<std::vector<ArchivedResult>>(
      *session_, [&] { return select_newest(session_->sql, filter, count, before); });
}

std::optional<std::int64_t> seconds_of_utc(std::string_view text) {
  constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ";
  if (text.size() != 10 && text.size() != kForm.size()) return std::nullopt;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool digit = text[i] >= '0' && text[i] <= '9';
    if (kForm[i] == 'd' ? !digit : text[i] != kForm[i]) return std::nullopt;
  }
  const auto number = [&](std::size_t from, std::size_t digits) {
    int value = 0;
    if (from + digits > text.size()) return value;
    std::from_chars(text.data() + from, text.data() + from + digits, value);
    return value;
  };
  namespace chr = std::chrono;
  const chr::year_month_day day(chr::year(number(0, 4)),
                                chr::month(static_cast<unsigned>(number(5, 2))),
                                chr::day(static_cast<unsigned>(number(8, 2))));
  const int hour = number(11, 2);
  const int minute = number(14, 2);
  const int second = number(17, 2);
  if (!day.ok() || hour > 23 || minute > 59 || second > 60) return std::nullopt;
  return chr::sys_seconds(chr::sys_days(day)).time_since_epoch().count() + hour * 3600 +
         minute * 60 + second;
}

}  // namespace rondure::record
