#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/run/ending.h"
#include "app/run/kept_trials.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "evaluation/results/evaluation.h"
#include "plans/plan.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/signature.h"
#include "reports/data/corrections.h"
#include "reports/formats/exports.h"
#include "reports/words/language.h"

namespace rondure::app {
namespace {

/// The list of digests, when it is signed.
std::string signed_checksums(const std::filesystem::path& directory) {
  if (!record::read_inside(directory, record::kSignatureName)) return {};
  return record::read_inside(directory, record::kChecksumsName).value_or("");
}

/// The requested formats, otherwise all that can be written here; corrections for machines only
/// where they were asked for once.
std::vector<std::string> formats_of(const ReportArguments& arguments) {
  if (!arguments.formats.empty()) return arguments.formats;
  std::vector<std::string> all = reports::all_formats();
  if (const auto browser = reports::find_browser(); !browser) {
    tell(fmt::format("rondure: report.pdf is not written: {}\n", browser.error().what));
    std::erase(all, "pdf");
  }
  std::error_code unknown;
  const bool corrected = std::filesystem::exists(
      std::filesystem::path(arguments.directory) / reports::kCorrectionsFile, unknown);
  if (!corrected) std::erase(all, name_of(record::Format::kCorrections));
  return all;
}

}  // namespace

int report(const ReportArguments& arguments) {
  const auto record = read_sound_record(arguments.directory);
  if (!record) return kBadInput;
  KeptTrials trials(arguments.directory);
  const auto evaluation = trials.evaluate(*record);
  if (!evaluation) return refuse(evaluation.error());
  const std::string signed_sums = signed_checksums(arguments.directory);
  const reports::Edition edition(
      reports::language_named(arguments.language).value_or(reports::Language::kEnglish),
      arguments.detail);
  const auto paper = arguments.paper.value_or(plans::recorded_paper(record->header.plan_text));
  const auto written = reports::write_exports(arguments.directory, formats_of(arguments), *record,
                                              *evaluation, edition, paper);
  if (!written) return refuse(written.error());
  if (record->sealed) trials.keep();
  if (signed_sums != signed_checksums(arguments.directory)) {
    tell("rondure: the reports differ from those that were signed; sign the run again\n");
  }
  say_result(arguments.directory, *record, *evaluation, edition.language, arguments.verbose,
             *written);
  return exit_status(evaluation->verdict);
}

}  // namespace rondure::app
