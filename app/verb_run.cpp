#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "app/archive_step.h"
#include "app/processor.h"
#include "app/resumption.h"
#include "app/terminal.h"
#include "app/verbs.h"
#include "plans/plan.h"
#include "plans/runner.h"
#include "record/files.h"
#include "record/journal.h"
#include "record/run_lock.h"
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

int exit_status(bool failed, reports::Verdict verdict) {
  if (failed) return kRunFailed;
  const bool well =
      verdict == reports::Verdict::kConforms || verdict == reports::Verdict::kNotToleranced;
  return well ? kAllWell : kNotConforming;
}

/// Where the run stands on disk, and what has to be said about it.
plans::RunOptions options_of(const RunArguments& arguments) {
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
  options.stop_requested = stop_requested;
  return options;
}

/// Measures, from the beginning or from the last touch on.
plans::RunOrRefusals measure(const plans::Plan& plan, plans::RunOptions options, bool resume,
                             bool quiet) {
  ProgressLine line(quiet);
  options.progress = [&line](const plans::Progress& progress) { line.show(progress); };
  if (resume) return plans::resume_plan(plan, options);
  auto run = plans::run_plan(plan, options);
  if (!run) return tl::unexpected(std::vector<core::Error>{run.error()});
  return std::move(*run);
}

void tell_how_to_go_on(const plans::Run& run, const fs::path& directory) {
  if (!run.failure || !plans::is_resumable(*run.failure)) return;
  tell(fmt::format("rondure: to go on behind the last touch: {}\n", resume_command(directory)));
}

/// A run directory that is not empty may hold a run to go on with.
void tell_about_resume(const fs::path& directory) {
  std::error_code ignored;
  if (!fs::exists(directory / record::kJournalName, ignored)) return;
  tell(fmt::format("rondure: to go on with the run that lies there: {}\n",
                   resume_command(directory)));
}

/// A run as its directory tells it.
struct Told {
  record::RunRecord record;
  reports::Evaluation evaluation;
};

core::Result<Told> read_and_evaluate(const fs::path& directory) {
  auto read = record::read_journal(directory);
  if (!read) return core::fail(read.error());
  auto evaluation = reports::evaluate_run(read->record, directory, processor());
  if (!evaluation) return core::fail(evaluation.error());
  return Told{std::move(read->record), std::move(*evaluation)};
}

/// Says why nothing is measured: a fault, or all that changed since the run began.
void refuse(const std::vector<core::Error>& reasons, bool resume, const fs::path& directory) {
  if (!resume || reasons.front().code != core::Code::kMeaning) return complain(reasons.front());
  tell(
      fmt::format("rondure: the run in {} cannot go on, it began with something else; undo this, "
                  "or start a new run:\n",
                  directory.string()));
  complain(reasons);
}

/// Evaluates what is on disk, not what is in memory; seals a finished run; writes the reports.
/// @param run  None for a run that was sealed before.
int conclude(const RunArguments& arguments, const plans::Plan& plan,
             const record::ArchivePlace& archive, const fs::path& directory, plans::Run* run) {
  const auto told = read_and_evaluate(directory);
  if (!told) {
    complain(told.error());
    return kRunFailed;
  }
  const reports::Evaluation& evaluation = told->evaluation;
  // An unfinished run stays open: it has no results to seal.
  if (run != nullptr && !run->failure) {
    if (auto sealed = run->journal.seal(reports::stored_results(evaluation)); !sealed) {
      complain(sealed.error());
      tell(fmt::format("rondure: every touch is kept; to finish the run: {}\n",
                       resume_command(directory)));
      return kRunFailed;
    }
  }
  const auto formats = arguments.formats.empty() ? plan.reports.formats : arguments.formats;
  const auto written = reports::write_exports(directory, formats, told->record, evaluation);
  if (!written) {
    complain(written.error());
    tell(
        fmt::format("rondure: the measurement is kept; then write the reports: rondure report {}\n",
                    directory.string()));
    return kRunFailed;
  }
  if (!arguments.quiet) {
    say(reports::write_summary(told->record, evaluation));
    for (const fs::path& file : *written) say(file.string() + "\n");
  }
  const bool failed = run != nullptr && run->failure;
  if (!failed) archive_run(archive, directory, told->record, evaluation);
  return exit_status(failed, evaluation.verdict);
}

/// What a run that died right behind its seal left to do on its journal. A damaged one stays as it
/// is: it must not look like a sound one.
core::Result<void> close_sealed(const fs::path& directory) {
  const auto read = record::read_journal(directory);
  if (!read) return core::fail(read.error());
  if (read->broken.empty()) return record::Journal::finish_seal(directory);
  return core::fail(core::Code::kJournal,
                    fmt::format("table {} of the sealed journal was changed: {}",
                                read->broken.front().table, read->broken.front().what),
                    directory.string());
}

/// A sealed run has nothing to measure; it may have died before its reports were written.
int finish_sealed(const RunArguments& arguments, const plans::Plan& plan,
                  const record::ArchivePlace& archive, const fs::path& directory) {
  const auto lock = record::RunLock::take(directory);
  if (!lock) {
    complain(lock.error());
    return kBadInput;
  }
  record::remove_temporaries(directory);
  if (auto closed = close_sealed(directory); !closed) {
    complain(closed.error());
    return kRunFailed;
  }
  const auto told = read_and_evaluate(directory);
  if (!told) {
    complain(told.error());
    return kRunFailed;
  }
  const auto formats = arguments.formats.empty() ? plan.reports.formats : arguments.formats;
  if (reports::exports_are_current(directory, formats, told->record, told->evaluation)) {
    tell(
        fmt::format("rondure: the run in {} is finished and sealed, there is nothing to resume; "
                    "its reports are there (again: rondure report {})\n",
                    directory.string(), directory.string()));
    return kBadInput;
  }
  tell(fmt::format("rondure: the run in {} is finished and sealed; only its reports are written\n",
                   directory.string()));
  return conclude(arguments, plan, archive, directory, nullptr);
}

/// The state of the run that is resumed; a run that is not resumed begins.
core::Result<Resumption> look(const RunArguments& arguments) {
  return arguments.resume ? find_resumption(arguments) : Resumption{};
}

}  // namespace

int run(const RunArguments& arguments) {
  const auto resumption = look(arguments);
  if (!resumption) {
    complain(resumption.error());
    return kBadInput;
  }
  const auto plan = plan_of(arguments, *resumption);
  if (!plan) {
    complain(plan.error());
    return kBadInput;
  }
  plans::RunOptions options = options_of(arguments);
  if (!resumption->directory.empty()) {
    options.directory = resumption->directory;
    options.run_id = last_folder(options.directory);
  }
  const auto archive = archive_of(arguments.archive, *plan, options.directory);
  if (!archive) {
    complain(archive.error());
    return kBadInput;
  }
  if (resumption->state == Resumption::State::kFinished)
    return finish_sealed(arguments, *plan, *archive, options.directory);
  const bool resume = resumption->state == Resumption::State::kGoesOn;
  if (arguments.resume && !resume && !arguments.quiet) {
    tell(fmt::format("rondure: {} holds no run yet; it begins\n", options.directory.string()));
  }
  listen_for_stop();
  auto run = measure(*plan, options, resume, arguments.quiet);
  if (!run) {
    refuse(run.error(), resume, options.directory);
    if (!arguments.resume) tell_about_resume(options.directory);
    return kBadInput;
  }
  if (run->failure) complain(*run->failure);
  const int status = conclude(arguments, *plan, *archive, options.directory, &*run);
  tell_how_to_go_on(*run, options.directory);
  return status;
}

}  // namespace rondure::app
