#pragma once

#include <optional>
#include <vector>

#include "core/result.h"
#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// A run that was started: its journal, and why it ended early, if it did.
struct Run {
  record::Journal journal;
  std::optional<core::Error> failure;
};

/// Whether resume_plan() can continue a run that ended with this fault. Findings from the touches
/// themselves (a probe that scatters, a part in another place) are final.
[[nodiscard]] bool is_resumable(const core::Error& failure);

/// Executes a plan: opens the cell, qualifies the probe, searches the pose of every feature, and
/// writes each touch into the journal before the next command goes to the machine.
///
/// @return An error when nothing has moved and nothing was written (unreachable target in the start
///         pose, directory in use); otherwise the run, whose journal states how it ended. After a
///         fault the tip was retracted, unless the machine itself had stopped on a collision.
[[nodiscard]] core::Result<Run> run_plan(const Plan& plan, const RunOptions& options);

/// Differences between a recorded run, interrupted or finished, and a run of this plan with these
/// options: one kMeaning each, as for resume_plan(); or the error of a file that cannot be read for
/// the comparison. Empty if they are the same run.
[[nodiscard]] std::vector<core::Error> differences_from_run(const record::RunRecord& run,
                                                            const Plan& plan,
                                                            const RunOptions& options);

/// A resumed run, or why it is refused: one error per change.
using RunOrRefusals = tl::expected<Run, std::vector<core::Error>>;

/// Resumes the interrupted run in `options.directory`. Replays the journal with the machine at rest
/// (see recorded_run.h). After the last touch it homes machine and fixture, repeats that touch and
/// up to two before it, and continues if none differs by more than the plan's resume_limit_um. The
/// repeated touches enter no result. On a simulated cell the record is, bit for bit, that of an
/// uninterrupted run, except for these checks and the decision that states the interruption.
///
/// With `relocate` a touch on the part that differs by more than the limit does not end the run:
/// the part is located again in that pose, and the current cloud, with its repeats, is measured
/// anew; the touches of the earlier placement stay in the journal and enter no result. A run that
/// was between two clouds still ends: its decisions hold for the earlier placement.
///
/// @param options  An absent `seed` or name is taken from the recorded run.
/// @param held  The journal of that directory, read once.
/// @return  kMeaning for each difference of the plan (`where` its JSON pointer, `what` the old and
///          the new value), of the points files, version, seed, serial number or operator; kJournal
///          for a sealed run; the errors of Journal::reopen(). In these cases nothing has moved and
///          the journal is unchanged.
[[nodiscard]] RunOrRefusals resume_plan(const Plan& plan, const RunOptions& options,
                                        record::HeldJournal held);

}  // namespace rondure::plans
