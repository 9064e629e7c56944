#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "app/processor.h"
#include "app/terminal.h"
#include "app/verbs.h"
#include "plans/plan.h"
#include "plans/runner.h"
#include "record/journal.h"
#include "reports/defect.h"
#include "reports/evaluation.h"
#include "reports/exports.h"
#include "reports/writers.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

/// "01_spool_simulated-20261121T023302Z"; a number follows while such a directory exists.
std::string run_name(const fs::path& plan, const std::string& utc, const fs::path& parent) {
  std::string compact;
  for (const char c : utc) {
    if (c != '-' && c != ':') compact += c;
  }
  const std::string name = plan.stem().string() + "-" + compact;
  std::string unique = name;
  std::error_code unknown;  // what cannot be looked at cannot be made either, and that is reported
  for (int i = 2; fs::exists(parent / unique, unknown); ++i) unique = fmt::format("{}-{}", name, i);
  return unique;
}

/// The name of a run: the folder itself, also for "runs/7/" and ".".
std::string last_folder(const fs::path& directory) {
  const fs::path whole = fs::absolute(directory).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

int exit_status(const plans::Run& run, reports::Verdict verdict) {
  if (run.failure) return kRunFailed;
  const bool well =
      verdict == reports::Verdict::kConforms || verdict == reports::Verdict::kNotToleranced;
  return well ? kAllWell : kNotConforming;
}

}  // namespace

int run(const RunArguments& arguments) {
  const auto plan = plans::read_plan(arguments.plan);
  if (!plan) {
    complain(plan.error());
    return kBadInput;
  }
  plans::RunOptions options;
  options.started_utc = utc_now();
  const fs::path parent = "runs";
  options.directory = arguments.out.empty()
                          ? parent / run_name(arguments.plan, options.started_utc, parent)
                          : fs::path(arguments.out);
  options.run_id = last_folder(options.directory);
  options.plan_file = fs::path(arguments.plan).filename().string();
  options.serial = arguments.serial;
  options.operator_name = arguments.operator_name;
  options.processor = processor();
  options.seed = arguments.seed;
  listen_for_stop();
  options.stop_requested = stop_requested;

  auto run = [&] {
    ProgressLine line(arguments.quiet);
    options.progress = [&line](const plans::Progress& progress) { line.show(progress); };
    return plans::run_plan(*plan, options);
  }();
  if (!run) {
    complain(run.error());
    return kBadInput;
  }
  if (run->failure) complain(*run->failure);

  // The reports are made from what is on disk, not from what is in memory.
  const auto read = record::read_journal(options.directory);
  if (!read) {
    complain(read.error());
    return kRunFailed;
  }
  const auto evaluation = reports::evaluate_run(read->record, options.directory, options.processor);
  if (!evaluation) {
    complain(evaluation.error());
    return kRunFailed;
  }
  // An unfinished run stays open: it has no results to seal.
  if (!run->failure) {
    if (auto sealed = run->journal.seal(reports::stored_results(*evaluation)); !sealed) {
      complain(sealed.error());
      return kRunFailed;
    }
  }
  const auto formats = arguments.formats.empty() ? plan->reports.formats : arguments.formats;
  const auto written =
      reports::write_exports(options.directory, formats, read->record, *evaluation);
  if (!written) {
    complain(written.error());
    tell(
        fmt::format("rondure: the measurement is kept; then write the reports: rondure report {}\n",
                    options.directory.string()));
    return kRunFailed;
  }
  if (!arguments.quiet) {
    say(reports::write_summary(read->record, *evaluation));
    for (const fs::path& file : *written) say(file.string() + "\n");
  }
  return exit_status(*run, evaluation->verdict);
}

}  // namespace rondure::app
