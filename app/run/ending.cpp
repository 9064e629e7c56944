#include "app/run/ending.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "app/run/archive_step.h"
#include "app/run/kept_trials.h"
#include "app/text/answer.h"
#include "app/text/terminal.h"
#include "evaluation/results/evaluation.h"
#include "plans/run/record.h"
#include "record/files.h"
#include "record/signature.h"
#include "reports/data/corrections.h"
#include "reports/formats/exports.h"
#include "reports/terminal/summary.h"
#include "reports/verify/stored_results.h"
#include "reports/words/language.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

/// Formats to write: those requested, and those left by an interrupted attempt, which would
/// otherwise show another state of the run.
std::vector<std::string> with_those_there(std::vector<std::string> asked,
                                          const fs::path& directory) {
  for (const reports::Export& e : reports::exports()) {
    std::error_code unknown;
    if (!fs::exists(directory / e.file, unknown)) continue;
    const std::string format(name_of(e.format));
    if (std::find(asked.begin(), asked.end(), format) == asked.end()) asked.push_back(format);
  }
  return asked;
}

reports::Edition edition_of(const RunArguments& arguments) {
  return {reports::language_named(arguments.language).value_or(reports::Language::kEnglish),
          arguments.detail};
}

reports::Paper paper_of(const RunArguments& arguments, const plans::Plan& plan) {
  return arguments.paper.value_or(plan.reports.paper);
}

/// A run read from its journal, with its evaluation.
struct EvaluatedRun {
  record::RunRecord record;
  evaluation::Evaluation evaluation;
  KeptTrials trials;
};

core::Result<void> require_sound(const record::ReadJournal& read, const fs::path& directory) {
  const std::vector<std::string> faults = record::faults_of(read);
  if (!faults.empty()) return core::fail(core::Code::kJournal, faults.front(), directory.string());
  auto checked = plans::check_record(read);
  if (!checked) return core::fail(checked.error().at(directory.string()));
  return {};
}

core::Result<EvaluatedRun> evaluate(record::RunRecord record, const fs::path& directory) {
  KeptTrials trials(directory);
  TRY(auto evaluation, trials.evaluate(record));
  return EvaluatedRun{std::move(record), std::move(evaluation), std::move(trials)};
}

core::Result<EvaluatedRun> read_and_evaluate(const fs::path& directory) {
  TRY(auto read, record::read_journal(directory));
  TRY_DO(require_sound(read, directory));
  return evaluate(std::move(read.record), directory);
}

/// Finishes the journal of a run that died right after it was sealed. A damaged journal is left
/// unchanged, so that it does not look valid.
core::Result<void> close_sealed(const record::ReadJournal& read, const fs::path& directory) {
  if (auto sound = require_sound(read, directory); !sound) return sound;
  return record::Journal::finish_seal(directory);
}

/// Archives a sealed run with its reports, which may have died before that step.
int finish_archived(const record::ArchivePlace& archive, const fs::path& directory,
                    const EvaluatedRun& evaluated) {
  evaluated.trials.keep();  // the last of its files: a run may have died before it
  if (archive_run(archive, directory, evaluated.record, evaluated.evaluation, true)) {
    tell(fmt::format(
        "rondure: the run in {} is finished and sealed; only its results had still to go to {}\n",
        directory.string(), archive.shown));
  } else {
    tell(fmt::format(
        "rondure: the run in {} is finished and sealed, there is nothing to resume: {}; its "
        "reports are there (again: rondure report {})\n",
        directory.string(), evaluation::name_of(evaluated.evaluation.verdict),
        quoted(directory.string())));
  }
  return exit_status(evaluated.evaluation.verdict);
}

/// Reports a failure on the terminal, and on the page, which would otherwise wait for a verdict.
/// Returns the exit status.
int fail_run(const core::Error& error, web::LiveView* live) {
  print_error(error);
  if (live != nullptr) live->show_failure(core::to_line(error));
  return kRunFailed;
}

/// @param run  Null for a run that was sealed before.
int conclude_evaluated(const RunToFinish& ending, const EvaluatedRun& evaluated, plans::Run* run) {
  const auto& [arguments, plan, archive, directory, live] = ending;
  const evaluation::Evaluation& evaluation = evaluated.evaluation;
  const bool failed = run != nullptr && run->failure;
  // An unfinished run stays open: it has no results to seal.
  if (run != nullptr && !failed) {
    if (auto sealed = run->journal.seal(reports::stored_results(evaluation)); !sealed) {
      const int status = fail_run(sealed.error(), live);
      tell(fmt::format("rondure: every touch is kept; to finish the run: {}\n",
                       resume_command(ending)));
      return status;
    }
  }
  if (!failed) keep_earlier_results(archive, directory, evaluated.record);
  const auto formats = with_those_there(formats_of(arguments, plan), directory);
  const reports::Edition edition = edition_of(arguments);
  const auto written = reports::write_exports(directory, formats, evaluated.record, evaluation,
                                              edition, paper_of(arguments, plan));
  if (!written) {
    const int status = fail_run(written.error(), live);
    if (!failed) {
      tell(
          fmt::format("rondure: the measurement is kept; to write its reports and archive it: {}\n",
                      resume_command(ending)));
    }
    return status;
  }
  if (!failed) evaluated.trials.keep();
  if (live != nullptr) {
    live->show_result(evaluated.record, evaluation, fs::absolute(directory).string());
  }
  if (!arguments.quiet) {
    say_result(directory, evaluated.record, evaluation, edition.language, arguments.verbose,
               *written);
  }
  if (failed) return kRunFailed;
  (void)archive_run(archive, directory, evaluated.record, evaluation, arguments.quiet);
  return exit_status(evaluation.verdict);
}

}  // namespace

int exit_status(evaluation::Verdict verdict) {
  const bool well =
      verdict == evaluation::Verdict::kConforms || verdict == evaluation::Verdict::kNotToleranced;
  return well ? kAllWell : kNotConforming;
}

const std::vector<std::string>& formats_of(const RunArguments& arguments, const plans::Plan& plan) {
  return arguments.formats.empty() ? plan.reports.formats : arguments.formats;
}

int conclude(const RunToFinish& ending, plans::Run& run) {
  const auto evaluated = [&ending] {
    const StopsAtOnce until_evaluated(fmt::format(
        "\nrondure: every touch is kept; to finish the run: {}\n", resume_command(ending)));
    return read_and_evaluate(ending.directory);
  }();
  if (!evaluated) return fail_run(evaluated.error(), ending.live);
  return conclude_evaluated(ending, *evaluated, &run);
}

int finish_sealed(const RunToFinish& ending, record::HeldJournal held) {
  const auto& [arguments, plan, archive, directory, live] = ending;
  record::remove_temporaries(directory);
  record::remove_temporaries(directory, reports::kCorrectionsFolder);
  if (auto closed = close_sealed(held.read, directory); !closed) {
    return fail_run(closed.error(), live);
  }
  const auto evaluated = evaluate(std::move(held.read.record), directory);
  if (!evaluated) return fail_run(evaluated.error(), live);
  if (reports::exports_are_current(directory, formats_of(arguments, plan), evaluated->record,
                                   evaluated->evaluation, edition_of(arguments),
                                   paper_of(arguments, plan))) {
    return finish_archived(archive, directory, *evaluated);
  }
  tell(fmt::format("rondure: the run in {} is finished and sealed; only its reports are written\n",
                   directory.string()));
  return conclude_evaluated(ending, *evaluated, nullptr);
}

void say_result(const fs::path& directory, const record::RunRecord& record,
                const evaluation::Evaluation& evaluation, reports::Language language, bool verbose,
                const std::vector<fs::path>& written) {
  say(verbose ? reports::write_summary(record, evaluation, language)
              : reports::write_answer(record, evaluation, language));
  fs::path report = written.empty() ? directory : written.front();
  for (const fs::path& file : written) {
    if (file.extension() == ".html") report = file;
    if (verbose) say_line(file.string());
    if (file.filename() != reports::kCorrectionsFile) continue;
    std::istringstream summary(record::read_file(file).value_or(""));
    for (std::string line; std::getline(summary, line);) {
      if (line.find(": none: ") != std::string::npos) say_line(line);
    }
  }
  std::error_code unknown;
  const bool is_signed = fs::exists(directory / record::kSignatureName, unknown);
  const std::string next =
      record.ending != "finished"
          ? ""
          : fmt::format("rondure {} {} --key {}", is_signed ? "verify" : "sign",
                        quoted(directory.string()), is_signed ? "PUBLIC.pem" : "KEY.pem");
  say_line(reports::write_whereabouts(report.string(), next, language));
}

std::optional<record::RunRecord> read_sound_record(const std::string& directory) {
  auto read = record::read_journal(directory);
  if (!read) {
    print_error(read.error());
    return std::nullopt;
  }
  const std::vector<std::string> faults = record::faults_of(*read);
  for (const std::string& fault : faults) tell(fmt::format("rondure: {}: {}\n", directory, fault));
  if (!faults.empty()) return std::nullopt;
  if (const auto checked = plans::check_record(*read); !checked) {
    print_error(checked.error().at(directory));
    return std::nullopt;
  }
  return std::move(read->record);
}

}  // namespace rondure::app
