#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "app/run/arguments.h"
#include "plans/plan.h"
#include "record/archive/place.h"
#include "record/journal/journal.h"
#include "web/view.h"

namespace rondure::app {

/// The run found for `rondure run ... --resume`.
struct Resumption {
  std::filesystem::path directory;
  /// Its journal, read once and locked from then on; none: the run starts, because there is no
  /// touch and no journal yet.
  std::optional<record::HeldJournal> held;
};

/// Examines the run for `--resume`: `--out`, or a run directory in place of the plan. kBadOption
/// when neither is given.
[[nodiscard]] core::Result<Resumption> find_resumption(const RunArguments& arguments);

/// The plan to resume with: the file named in the arguments, otherwise the one in the journal;
/// kFile when the plan in the journal needs files beside it.
[[nodiscard]] plans::PlanOrProblems plan_of(const RunArguments& arguments, const Resumption& run);

/// A run in its directory, with the data needed to finish it.
struct RunToFinish {
  const RunArguments& arguments;
  const plans::Plan& plan;
  const record::ArchivePlace& archive;
  std::filesystem::path directory;
  web::LiveView* live = nullptr;  ///< Shows the result to watchers; may be null.
};

/// The shell command that resumes a run: with the plan if it needs files beside it, and with the
/// named archive (without its password).
[[nodiscard]] std::string resume_command(const RunToFinish& run);

}  // namespace rondure::app
