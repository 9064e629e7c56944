#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "app/run/archive_step.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "core/encodings.h"
#include "evaluation/evaluate.h"
#include "plans/run/record.h"
#include "record/archive/queue.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "reports/history/history.h"
#include "reports/words/language.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;
using record::ArchivedResult;

constexpr std::size_t kListed = 50;
constexpr std::size_t kCharted = 1000;
constexpr std::size_t kAll = static_cast<std::size_t>(-1);
constexpr std::size_t kPage = 5000;  ///< Rows per query: short locks, little memory.

tl::unexpected<core::Error> bad(std::string what) {
  return core::fail(core::Code::kBadOption, std::move(what));
}

core::Result<std::optional<std::int64_t>> time_of(const std::string& text, const char* option,
                                                  bool end_of_day) {
  if (text.empty()) return std::optional<std::int64_t>();
  const auto seconds = record::seconds_of_utc(text);
  if (!seconds) {
    return bad(
        fmt::format("{} {}: give a day or a time in UTC, 2026-11-21 or "
                    "2026-11-21T14:30:00Z",
                    option, core::printable(text)));
  }
  const bool day = text.size() == 10;
  return std::optional<std::int64_t>(*seconds + (day && end_of_day ? 86'399 : 0));
}

core::Result<record::ArchiveFilter> filter_of(const HistoryArguments& arguments) {
  record::ArchiveFilter filter = arguments.filter;
  TRY(const auto since, time_of(arguments.since, "--since", false));
  TRY(const auto until, time_of(arguments.until, "--until", true));
  filter.since_s = since;
  filter.until_s = until;
  if (arguments.verdict.empty()) return filter;
  std::string verdict = arguments.verdict;
  std::replace(verdict.begin(), verdict.end(), '-', ' ');
  using evaluation::Verdict;
  for (const Verdict known : {Verdict::kConforms, Verdict::kDoesNotConform, Verdict::kUndecided,
                              Verdict::kVoid, Verdict::kNotToleranced}) {
    if (verdict != evaluation::name_of(known)) continue;
    filter.verdict = verdict;
    return filter;
  }
  return bad(
      fmt::format("--verdict {} is unknown; give conforms, does-not-conform, undecided, void "
                  "or not-toleranced",
                  core::printable(arguments.verdict)));
}

/// The newest `count` results, page by page; `take` receives each page, newest first, and returns
/// whether it wants more.
template <class Take>
core::Result<void> read_pages(record::Archive& archive, const record::ArchiveFilter& filter,
                              std::size_t count, const Take& take) {
  std::optional<ArchivedResult> last;
  while (count > 0) {
    const std::size_t page = std::min(count, kPage);
    TRY(auto results, archive.newest(filter, page, last ? &*last : nullptr));
    if (results.empty()) return {};
    last = results.back();
    count -= results.size();
    if (!take(std::move(results))) return {};
  }
  return {};
}

/// The newest `count` runs with their results.
/// @return  Whether there are older ones.
core::Result<bool> show_runs(record::Archive& archive, const record::ArchiveFilter& filter,
                             std::size_t count) {
  std::vector<ArchivedResult> all;
  std::size_t runs = 0;
  TRY_DO(read_pages(archive, filter, kAll, [&](const std::vector<ArchivedResult>& page) {
    for (const ArchivedResult& one : page) {
      if (all.empty() || !reports::in_one_run(all.back(), one)) ++runs;
      if (runs > count) return false;
      all.push_back(one);
    }
    return true;
  }));
  say(all.empty() ? "no results\n" : reports::history_table(all));
  return runs > count;
}

core::Result<void> write_csv(record::Archive& archive, const record::ArchiveFilter& filter,
                             const HistoryArguments& arguments) {
  const std::size_t count = arguments.last.value_or(kAll);
  if (arguments.csv == "-") {
    say(reports::history_csv_header());
    return read_pages(archive, filter, count, [](const std::vector<ArchivedResult>& page) {
      say(reports::history_csv_rows(page));
      return true;
    });
  }
  std::string text = reports::history_csv_header();
  auto read = read_pages(archive, filter, count, [&](const std::vector<ArchivedResult>& page) {
    text += reports::history_csv_rows(page);
    return true;
  });
  if (!read) return read;
  if (auto written = record::write_file(arguments.csv, text); !written) return written;
  say_line(arguments.csv);
  return {};
}

core::Result<void> write_svg(const reports::RunChart& chart, const std::string& file) {
  if (chart.results.empty()) return bad("there is no result with a value to draw");
  if (auto written = record::write_file(file, reports::history_svg(chart)); !written) {
    return written;
  }
  say_line(file);
  return {};
}

bool is_coloured() { return isatty(STDOUT_FILENO) == 1 && std::getenv("NO_COLOR") == nullptr; }

core::Result<void> show(record::Archive& archive, const std::string& place,
                        const HistoryArguments& arguments) {
  TRY(const auto filter, filter_of(arguments));
  if (!arguments.csv.empty()) return write_csv(archive, filter, arguments);
  if (!arguments.chart && !arguments.json && arguments.svg.empty()) {
    const std::size_t count = arguments.last.value_or(kListed);
    TRY(const bool more, show_runs(archive, filter, count));
    if (more)
      say(fmt::format("the newest {}; older ones with --last N, all with --csv FILE\n", count));
    return {};
  }
  const std::size_t count = arguments.last.value_or(kCharted);
  std::vector<ArchivedResult> results;  // one more shows whether there are older ones
  TRY_DO(read_pages(archive, filter, count + 1, [&](const std::vector<ArchivedResult>& page) {
    results.insert(results.end(), page.begin(), page.end());
    return true;
  }));
  const bool more = results.size() > count;
  if (more) results.resize(count);
  const reports::RunChart chart = reports::run_chart_of(results);
  if (arguments.json) say(reports::history_json(place, results, more, chart));
  if (arguments.chart) say(reports::history_chart(chart, is_coloured()));
  if (!arguments.svg.empty()) return write_svg(chart, arguments.svg);
  return {};
}

/// Pushes one archive's share of the queue.
bool push_to(const record::ArchivePlace& place, const fs::path& queue) {
  record::DeliveryOptions options;
  options.give_up_after_s = 600.0;  // a person waits for it, and may press Ctrl-C
  const record::Delivery delivery = record::deliver(place, queue, nullptr, options);
  if (delivery.failure) print_error(*delivery.failure);
  if (delivery.queue_failure) print_error(*delivery.queue_failure);
  say_line(fmt::format("{}: {} sent ({}), {}", place.shown,
                       reports::count(delivery.sent, "run", "runs"),
                       reports::count(delivery.results, "result", "results"),
                       reports::count(delivery.waiting, "waits", "wait")));
  return !delivery.failure && !delivery.queue_failure;
}

int push(const record::ArchivePlace& place, const HistoryArguments& arguments) {
  std::error_code unknown;
  if (!fs::exists(arguments.queue, unknown)) {
    say_line(fmt::format("nothing waits: there is no {}", arguments.queue));
    return kAllWell;
  }
  if (arguments.archive) return push_to(place, arguments.queue) ? kAllWell : kBadInput;
  auto queue = record::ArchiveQueue::open(arguments.queue);
  const auto targets = queue ? queue->targets() : core::fail(queue.error());
  if (!targets) return refuse(targets.error());
  if (targets->empty()) say("nothing waits\n");
  bool well = true;
  for (const std::string& target : *targets) {
    auto waited_for = record::parse_archive_place(target);
    if (!waited_for) {
      print_error(waited_for.error());
      well = false;
      continue;
    }
    waited_for->key = target;  // older versions may have stored a password in it
    well = push_to(*waited_for, arguments.queue) && well;
  }
  return well ? kAllWell : kBadInput;
}

core::Result<record::ArchiveRun> finished_run(const fs::path& directory) {
  TRY(const auto read, record::read_journal(directory));
  const std::vector<std::string> faults = record::faults_of(read);
  if (!read.record.sealed || !faults.empty()) {
    return core::fail(core::Code::kJournal,
                      fmt::format("{}: {}; only finished runs are archived", directory.string(),
                                  faults.empty() ? "the run did not finish" : faults.front()),
                      directory.string());
  }
  if (auto checked = plans::check_record(read); !checked) {
    return core::fail(checked.error().at(directory.string()));
  }
  TRY(const auto evaluation, evaluation::evaluate(read.record));
  return entry_of(directory, read.record, evaluation);
}

int add(record::Archive& archive, const std::vector<std::string>& directories) {
  int status = kAllWell;
  for (const std::string& directory : directories) {
    const auto run = finished_run(directory);
    const auto added = run ? archive.push(*run) : core::fail(run.error());
    if (!added) {
      print_error(added.error());
      status = kBadInput;
      continue;
    }
    say_line(*added ? fmt::format("{}: {} added", directory,
                                  reports::count(run->results.size(), "result", "results"))
                    : fmt::format("{}: was in the archive already", directory));
  }
  return status;
}

}  // namespace

int history(const HistoryArguments& arguments) {
  const auto place = record::parse_archive_place(arguments.archive.value_or("runs/archive.db"));
  if (!place || place->kind == record::ArchivePlace::Kind::kNone) {
    print_error(place ? bad("none is no archive; give a file or postgresql://...").value()
                      : place.error());
    return kBadInput;
  }
  if (arguments.push) return push(*place, arguments);
  using Access = record::Archive::Access;
  auto archive =
      record::Archive::open(*place, arguments.add.empty() ? Access::kRead : Access::kWrite);
  if (!archive) return refuse(archive.error());
  if (!arguments.add.empty()) return add(*archive, arguments.add);
  if (auto shown = show(*archive, place->shown, arguments); !shown) return refuse(shown.error());
  return kAllWell;
}

}  // namespace rondure::app
