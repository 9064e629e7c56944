#pragma once

#include <filesystem>

#include "app/verbs.h"
#include "plans/plan.h"
#include "plans/runner.h"
#include "record/archive.h"
#include "record/journal.h"
#include "reports/live_view.h"

namespace rondure::app {

/// A run in its directory, and what its end needs.
struct RunToFinish {
  const RunArguments& arguments;
  const plans::Plan& plan;
  const record::ArchivePlace& archive;
  std::filesystem::path directory;
  reports::LiveView* live = nullptr;  ///< Who watches is shown the result; or none.
};

/// Reads and evaluates the journal on disk, not the rows in memory; seals a finished run; writes
/// the reports; archives a finished run.
/// @return  Exit status of the program.
[[nodiscard]] int conclude(const RunToFinish& ending, plans::Run& run);

/// A sealed run has nothing to measure; it may have died before its reports were written or its
/// results archived.
/// @param held  Its journal.
/// @return  Exit status of the program.
[[nodiscard]] int finish_sealed(const RunToFinish& ending, record::HeldJournal held);

}  // namespace rondure::app
