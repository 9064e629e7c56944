#pragma once

#include <filesystem>

#include "app/verbs/verbs.h"
#include "plans/plan.h"
#include "plans/run/runner.h"
#include "record/archive/archive.h"
#include "web/view.h"

namespace rondure::app {

/// A run in its directory, with the data that its end needs.
struct RunToFinish {
  const RunArguments& arguments;
  const plans::Plan& plan;
  const record::ArchivePlace& archive;
  std::filesystem::path directory;
  reports::LiveView* live = nullptr;  ///< Shows the result to watchers; may be null.
};

/// Evaluates the journal on disk, not the data in memory; seals a finished run; writes the reports;
/// archives a finished run.
/// @param run  Null for a run that was sealed before.
/// @return  Exit status of the program.
[[nodiscard]] int conclude(const RunToFinish& ending, plans::Run* run);

/// Completes a sealed run, which may have died before its reports were written or its results
/// archived. Measures nothing.
/// @return  Exit status of the program.
[[nodiscard]] int finish_sealed(const RunToFinish& ending);

}  // namespace rondure::app
