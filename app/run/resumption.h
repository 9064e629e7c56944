#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/run/ending.h"
#include "app/verbs/verbs.h"
#include "plans/run/runner.h"
#include "record/journal/journal.h"

namespace rondure::app {

/// The run that `rondure run ... --resume` goes on with.
struct Resumption {
  std::filesystem::path directory;
  /// Its journal, read once and locked from then on; none: no touch and no journal yet, the run
  /// begins.
  std::optional<record::HeldJournal> held;
};

/// Looks at the run that `--resume` means: `--out`, or a run directory in place of the plan.
/// kBadOption when neither is given.
[[nodiscard]] core::Result<Resumption> find_resumption(const RunArguments& arguments);

/// The plan to go on with: the file named in the arguments, or else the one in the journal; kFile
/// when that one needs files beside it.
[[nodiscard]] plans::PlanOrProblems plan_of(const RunArguments& arguments, const Resumption& run);

/// The command that goes on with a run, as a shell reads it: with the plan where files stand beside
/// it, and with the archive that was named (without its password).
[[nodiscard]] std::string resume_command(const RunToFinish& run);

}  // namespace rondure::app
