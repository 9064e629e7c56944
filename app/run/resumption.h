#pragma once

#include <filesystem>
#include <string>

#include "app/run/ending.h"
#include "app/verbs/verbs.h"
#include "plans/run/runner.h"

namespace rondure::app {

/// What `rondure run ... --resume` has before it.
struct Resumption {
  enum class State {
    kNothingThere,  ///< No touch and no journal yet: begin.
    kGoesOn,        ///< Interrupted, stopped or failed.
    kFinished,      ///< Sealed: there is nothing to measure.
  };
  State state = State::kNothingThere;
  std::filesystem::path directory;
  std::string plan_text;  ///< Of the journal; empty when there is none.
  std::string plan_file;  ///< Its name then.
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
