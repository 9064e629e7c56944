#include "app/run/kept_trials.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "app/run/processor.h"
#include "app/text/terminal.h"
#include "evaluation/defect.h"
#include "evaluation/uncertainty/kept_draws.h"
#include "record/checksums.h"
#include "record/files.h"
#include "record/journal/journal.h"
#include "record/sha256.h"
#include "record/signature.h"

namespace rondure::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostTrialsBytes = std::uintmax_t{1} << 30;  // 1 GiB

/// The program as its bytes, because another build draws otherwise, whatever its version says; the
/// processor; the journal.
std::string head_of_file(const fs::path& directory) {
  const auto program = record::read_file("/proc/self/exe");
  const auto journal = record::sha256_inside(directory, record::kJournalName);
  return fmt::format("rondure trials\nprogram {}\nprocessor {}\njournal {}\n",
                     program ? record::sha256_hex(*program) : "unknown", processor(),
                     journal.value_or("unknown"));
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
    tell(fmt::format("rondure: {}: {}; the intervals are computed again\n",
                     (directory_ / kTrialsFile).string(), known.error().what));
  }
}

core::Result<evaluation::Evaluation> KeptTrials::evaluate(const record::RunRecord& record) {
  evaluation::KeptDraws draws(taken_);
  const evaluation::UseOfDraws use(draws);
  auto found = evaluation::evaluate_run(record, directory_, processor());
  drawn_ = draws.bytes();
  return found;
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

}  // namespace rondure::app
