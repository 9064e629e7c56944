#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/processor.h"
#include "app/sketch_style.h"
#include "app/terminal.h"
#include "app/verbs.h"
#include "plans/record_check.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/journal.h"
#include "record/signature.h"
#include "reports/defect.h"
#include "reports/evaluation.h"
#include "reports/exports.h"
#include "reports/language.h"
#include "reports/summary.h"

namespace rondure::app {
namespace {

/// The list of digests, when there is a signature of it.
std::string signed_checksums(const std::filesystem::path& directory) {
  if (!record::read_file(directory / record::kSignatureName)) return {};
  return record::read_file(directory / record::kChecksumsName).value_or("");
}

}  // namespace

int report(const ReportArguments& arguments) {
  const auto read = record::read_journal(arguments.directory);
  if (!read) {
    complain(read.error());
    return kBadInput;
  }
  const std::vector<std::string> faults = record::faults_of(*read);
  for (const std::string& fault : faults) {
    tell(fmt::format("rondure: {}: {}\n", arguments.directory, fault));
  }
  if (!faults.empty()) return kBadInput;
  if (const auto checked = plans::check_record(read->record); !checked) {
    complain(checked.error().at(arguments.directory));
    return kBadInput;
  }
  const auto evaluation = reports::evaluate_run(read->record, arguments.directory, processor());
  if (!evaluation) {
    complain(evaluation.error());
    return kBadInput;
  }
  const std::string signed_sums = signed_checksums(arguments.directory);
  const auto formats = arguments.formats.empty() ? reports::all_formats() : arguments.formats;
  const auto language =
      reports::language_named(arguments.language).value_or(reports::Language::kEnglish);
  const auto written =
      reports::write_exports(arguments.directory, formats, read->record, *evaluation, language);
  if (!written) {
    complain(written.error());
    return kBadInput;
  }
  for (const std::string& warning : written->warnings) tell(fmt::format("rondure: {}\n", warning));
  if (signed_sums != signed_checksums(arguments.directory)) {
    tell("rondure: the reports differ from those that were signed; sign the run again\n");
  }
  say(reports::write_summary(read->record, *evaluation, sketch_style(), language));
  for (const auto& file : written->files) say_line(file.string());
  const bool well = evaluation->verdict == reports::Verdict::kConforms ||
                    evaluation->verdict == reports::Verdict::kNotToleranced;
  return well ? kAllWell : kNotConforming;
}

}  // namespace rondure::app
