#include "app/run/kept_trials.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "app/text/terminal.h"
#include "evaluation/defect.h"
#include "evaluation/uncertainty/kept_draws.h"
#include "plans/run/record.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "record/sha256.h"
#include "record/signature.h"

namespace rondure::app {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "unknown processor";
  std::string units;
  for (std::string line; std::getline(info, line);) {
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    if (line.rfind("model name", 0) == 0 && colon + 2 <= line.size())
      model = line.substr(colon + 2);
    if (line.rfind("flags", 0) != 0) continue;
    std::istringstream flags(line.substr(colon + 1));
    for (std::string flag; flags >> flag;) {
      if (flag == "fma" || flag == "avx2" || flag == "avx512f") units += " " + flag;
    }
    break;  // the other cores are identical
  }
  return model + " (" + (units.empty() ? "no fma" : units.substr(1)) + ")";
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const auto length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

namespace {

namespace fs = std::filesystem;
using evaluation::kTrialsFile;

constexpr std::uintmax_t kMostTrialsBytes = std::uintmax_t{1} << 30;  // 1 GiB

/// The program as its bytes, because another build draws otherwise, whatever its version says; the
/// processor; the journal.
std::string head_of_file(const fs::path& directory) {
  const auto program = record::sha256_file("/proc/self/exe");
  const auto journal = record::sha256_inside(directory, record::kJournalName);
  return fmt::format("rondure trials\nprogram {}\nprocessor {}\njournal {}\n",
                     program.value_or("unknown"), processor(), journal.value_or("unknown"));
}

/// The draws of the directory, behind their head.
core::Result<std::string> known_draws(const fs::path& directory, const std::string& sha256) {
  TRY(std::string bytes, record::read_inside(directory, kTrialsFile, kMostTrialsBytes));
  if (record::sha256_hex(bytes) != sha256) {
    return core::fail(core::Code::kFile, fmt::format("it was changed after it was written ({})",
                                                     record::kChecksumsName));
  }
  const std::string head = head_of_file(directory);
  if (!bytes.starts_with(head)) {
    return core::fail(core::Code::kFile,
                      "another build, another processor or another run wrote it");
  }
  return bytes.substr(head.size());
}

}  // namespace

KeptTrials::KeptTrials(fs::path directory) : directory_(std::move(directory)) {
  const auto sums = record::read_checksums(directory_);
  if (!sums) return;
  const auto line = std::ranges::find(*sums, kTrialsFile, &record::Checksum::file);
  if (line == sums->end()) return;
  auto known = known_draws(directory_, line->sha256);
  if (known) {
    taken_ = *std::move(known);
  } else {
    tell_drawn_again(known.error().what);
  }
}

core::Result<evaluation::Evaluation> KeptTrials::evaluate(const record::RunRecord& record) {
  const auto checked_with = [&record](evaluation::KeptDraws& draws) {
    const evaluation::UseOfDraws use(draws);
    return evaluation::evaluate_checked(record);
  };
  evaluation::KeptDraws known(taken_);
  evaluation::CheckedEvaluation checked = checked_with(known);
  drawn_ = known.bytes();
  // Some were drawn: those that were kept are of another shape.
  if (!taken_.empty() && (!drawn_.empty() || !reports::gives_stored_results(
                                                 record, checked.evaluation, processor()))) {
    tell_drawn_again("its draws do not give the results under the seal of the journal");
    taken_.clear();
    evaluation::KeptDraws made;
    checked = checked_with(made);
    drawn_ = made.bytes();
  }
  TRY_DO(evaluation::keep_defects(checked.defects, record.header, directory_, processor()));
  return std::move(checked.evaluation);
}

void KeptTrials::tell_drawn_again(const std::string& why) const {
  tell(fmt::format("rondure: {}: {}; the intervals are computed again\n",
                   (directory_ / kTrialsFile).string(), why));
}

void KeptTrials::keep() const {
  std::error_code unknown;
  if (!taken_.empty() || drawn_.empty()) return;
  if (fs::exists(directory_ / record::kSignatureName, unknown)) return;
  const std::string bytes = head_of_file(directory_) + drawn_;
  auto kept = record::write_inside(directory_, kTrialsFile, bytes);
  if (kept) {
    kept = record::update_checksums(directory_, {{kTrialsFile, record::sha256_hex(bytes)}});
  }
  if (!kept) {
    tell(fmt::format("rondure: {} is not kept: {}; the reports stand, the next one takes longer\n",
                     kTrialsFile, kept.error().what));
  }
}

reports::VerifyOptions verify_options(const fs::path& directory) {
  reports::VerifyOptions options;
  options.processor = processor();
  std::error_code unknown;
  if (fs::exists(directory / kTrialsFile, unknown)) options.trials_head = head_of_file(directory);
  options.check = plans::check_record;
  return options;
}

}  // namespace rondure::app
