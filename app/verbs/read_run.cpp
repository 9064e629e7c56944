#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/run/ending.h"
#include "app/run/kept_trials.h"
#include "app/text/terminal.h"
#include "app/verbs/verbs.h"
#include "evaluation/factors/study.h"
#include "evaluation/results/evaluation.h"
#include "plans/plan.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/signature.h"
#include "reports/data/analyses.h"
#include "reports/data/corrections.h"
#include "reports/formats/exports.h"
#include "reports/terminal/factors.h"
#include "reports/verify/verify.h"
#include "reports/words/language.h"

namespace rondure::app {

int verify(const VerifyArguments& arguments) {
  reports::VerifyOptions options = verify_options(arguments.directory);
  if (!arguments.key.empty()) {
    const auto key = record::read_file(arguments.key);
    if (!key) return refuse(key.error());
    options.public_key_pem = *key;
  }
  const auto outcome = reports::verify_run(arguments.directory, options);
  if (!outcome) {
    const bool of_key = outcome.error().code == core::Code::kBadOption;
    return refuse(of_key ? outcome.error().at(arguments.key) : outcome.error());
  }
  for (const std::string& difference : outcome->differences)
    say_line(fmt::format("not equal: {}", difference));
  const bool equal = outcome->differences.empty();
  if (equal) say_line(fmt::format("equal: {}", outcome->what_was_compared));
  for (const std::string& note : outcome->notes) say_line(fmt::format("note: {}", note));
  return equal ? kAllWell : kNotConforming;
}

int compare(const CompareArguments& arguments) {
  const auto record = read_sound_record(arguments.directory);
  if (!record) return kBadInput;
  if (record->ending != "finished") {
    tell(
        fmt::format("rondure: {}: the run did not finish; its values are void, and what is said of "
                    "them holds for the touches so far\n",
                    arguments.directory));
  }
  const auto evaluation = KeptTrials(arguments.directory).evaluate(*record);
  if (!evaluation) return refuse(evaluation.error());
  const auto comparison = evaluation::compare_run(*evaluation);
  if (!comparison) return refuse(comparison.error().at(arguments.directory));
  const std::string& id = record->header.run_id;
  say(arguments.json ? reports::comparison_json(id, *comparison)
                     : reports::comparison_text(id, *comparison, arguments.all));
  return kAllWell;
}

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

namespace {

namespace fs = std::filesystem;

/// Whether the run verifies: no other run should be signed.
bool verifies(const fs::path& directory) {
  const auto outcome = reports::verify_run(directory, verify_options(directory));
  if (!outcome) {
    print_error(outcome.error());
    return false;
  }
  for (const std::string& difference : outcome->differences) {
    tell(fmt::format("rondure: not signed, because not equal: {}\n", difference));
  }
  return outcome->differences.empty();
}

/// Says when other users of the computer could sign in the signer's name.
void tell_readable_key(const fs::path& key) {
  std::error_code unknown;
  const fs::perms others =
      fs::status(key, unknown).permissions() & (fs::perms::group_read | fs::perms::others_read);
  if (unknown || others == fs::perms::none) return;
  tell(
      fmt::format("rondure: note: other users of this computer can read the private key {}; "
                  "chmod 600 keeps it to yourself\n",
                  key.string()));
}

/// @return  Which key signed.
core::Result<std::string> write_signature(const SignArguments& arguments) {
  const fs::path directory = arguments.directory;
  TRY(const auto key, record::read_file(arguments.key));
  TRY(const auto sums, record::read_inside(directory, record::kChecksumsName));
  const auto signature = record::sign(sums, key);
  if (!signature) return core::fail(signature.error().at(arguments.key));
  const auto before = record::read_inside(directory, record::kSignatureName);
  if (before && *before != signature->bytes) {
    tell("rondure: note: this replaces a signature, of another key or of other files\n");
  }
  TRY_DO(record::write_file(directory / record::kSignatureName, signature->bytes));
  return signature->key_sha256;
}

}  // namespace

int sign(const SignArguments& arguments) {
  if (!verifies(arguments.directory)) return kBadInput;
  const auto key = write_signature(arguments);
  if (!key) return refuse(key.error());
  tell_readable_key(arguments.key);
  say_line((fs::path(arguments.directory) / record::kSignatureName).string());
  say_line(fmt::format("signed with the key {}", *key));
  return kAllWell;
}

}  // namespace rondure::app
