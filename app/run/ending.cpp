#include "app/run/ending.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/run/archive_step.h"
#include "app/processor.h"
#include "app/run/resumption.h"
#include "app/text/shell_word.h"
#include "app/text/sketch_style.h"
#include "app/text/terminal.h"
#include "plans/checks/record.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "record/run_lock.h"
#include "reports/defect.h"
#include "reports/evaluation.h"
#include "reports/exports.h"
#include "reports/words/language.h"
#include "reports/verdict.h"
#include "reports/writers.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

int exit_status(bool failed, reports::Verdict verdict) {
  if (failed) return kRunFailed;
  const bool well =
      verdict == reports::Verdict::kConforms || verdict == reports::Verdict::kNotToleranced;
  return well ? kAllWell : kNotConforming;
}

/// Formats to write: those requested, and those left by an interrupted attempt, which would show
/// another state of the run.
std::vector<std::string> with_those_there(std::vector<std::string> asked,
                                          const fs::path& directory) {
  for (const reports::Export& e : reports::exports()) {
    std::error_code unknown;
    if (!fs::exists(directory / e.file, unknown)) continue;
    if (std::find(asked.begin(), asked.end(), e.format) == asked.end()) asked.push_back(e.format);
  }
  return asked;
}

reports::Language language_of(const RunArguments& arguments) {
  return reports::language_named(arguments.language).value_or(reports::Language::kEnglish);
}

/// A run as read from its directory.
struct Told {
  record::RunRecord record;
  reports::Evaluation evaluation;
};

core::Result<void> require_sound(const record::ReadJournal& read, const fs::path& directory) {
  const std::vector<std::string> faults = record::faults_of(read);
  if (!faults.empty()) {
    return core::fail(core::Code::kJournal, faults.front(), directory.string());
  }
  auto checked = plans::check_record(read.record);
  if (!checked) return core::fail(checked.error().at(directory.string()));
  return {};
}

core::Result<Told> read_and_evaluate(const fs::path& directory) {
  auto read = record::read_journal(directory);
  if (!read) return core::fail(read.error());
  if (auto sound = require_sound(*read, directory); !sound) return core::fail(sound.error());
  auto evaluation = reports::evaluate_run(read->record, directory, processor());
  if (!evaluation) return core::fail(evaluation.error());
  return Told{std::move(read->record), std::move(*evaluation)};
}

/// Completes the journal of a run that died just after its seal. A damaged one is not changed: it
/// must not look sound.
core::Result<void> close_sealed(const fs::path& directory) {
  const auto read = record::read_journal(directory);
  if (!read) return core::fail(read.error());
  if (auto sound = require_sound(*read, directory); !sound) return sound;
  return record::Journal::finish_seal(directory);
}

/// A sealed run with its reports may have died before it was archived.
int finish_archived(const record::ArchivePlace& archive, const fs::path& directory,
                    const Told& told) {
  if (archive_run(archive, directory, told.record, told.evaluation)) {
    tell(fmt::format(
        "rondure: the run in {} is finished and sealed; only its results had still to go to {}\n",
        directory.string(), archive.shown));
  } else {
    tell(fmt::format(
        "rondure: the run in {} is finished and sealed, there is nothing to resume: {}; its "
        "reports are there (again: rondure report {})\n",
        directory.string(), reports::name_of(told.evaluation.verdict), quoted(directory.string())));
  }
  return exit_status(false, told.evaluation.verdict);
}

/// Reports a failure on the terminal, and to the page, which would otherwise wait for a verdict.
void tell_failure(const core::Error& error, reports::LiveView* live) {
  complain(error);
  if (live != nullptr) live->show_failure(core::to_line(error));
}

}  // namespace

int conclude(const RunToFinish& ending, plans::Run* run) {
  const auto& [arguments, plan, archive, directory, live] = ending;
  const auto told = read_and_evaluate(directory);
  if (!told) {
    tell_failure(told.error(), live);
    return kRunFailed;
  }
  const reports::Evaluation& evaluation = told->evaluation;
  const bool failed = run != nullptr && run->failure;
  // An unfinished run stays open: it has no results to seal.
  if (run != nullptr && !failed) {
    if (auto sealed = run->journal.seal(reports::stored_results(evaluation)); !sealed) {
      tell_failure(sealed.error(), live);
      tell(fmt::format("rondure: every touch is kept; to finish the run: {}\n",
                       resume_command(ending)));
      return kRunFailed;
    }
  }
  if (!failed) keep_earlier_results(archive, directory, told->record);
  const auto formats = with_those_there(
      arguments.formats.empty() ? plan.reports.formats : arguments.formats, directory);
  const reports::Language language = language_of(arguments);
  const auto written =
      reports::write_exports(directory, formats, told->record, evaluation, language);
  if (!written) {
    tell_failure(written.error(), live);
    if (!failed) {
      tell(
          fmt::format("rondure: the measurement is kept; to write its reports and archive it: {}\n",
                      resume_command(ending)));
    }
    return kRunFailed;
  }
  for (const std::string& warning : written->warnings) tell(fmt::format("rondure: {}\n", warning));
  if (live != nullptr) {
    live->show_result(told->record, evaluation, fs::absolute(directory).string());
  }
  if (!arguments.quiet) {
    say(reports::write_summary(told->record, evaluation, sketch_style(), language));
    for (const fs::path& file : written->files) say_line(file.string());
  }
  if (!failed) (void)archive_run(archive, directory, told->record, evaluation);
  return exit_status(failed, evaluation.verdict);
}

int finish_sealed(const RunToFinish& ending) {
  const auto& [arguments, plan, archive, directory, live] = ending;
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
  if (reports::exports_are_current(directory, formats, told->record, told->evaluation,
                                   language_of(arguments))) {
    return finish_archived(archive, directory, *told);
  }
  tell(fmt::format("rondure: the run in {} is finished and sealed; only its reports are written\n",
                   directory.string()));
  return conclude(ending, nullptr);
}

}  // namespace rondure::app
