#pragma once

#include <optional>
#include <vector>

#include "core/result.h"
#include "plans/plan.h"
#include "plans/run_options.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// A run that began: its journal, and why it ended early if it did.
struct Run {
  record::Journal journal;
  std::optional<core::Error> failure;
};

/// Whether a run that ended so can go on with resume_plan(): a fault that can be put right. What
/// the touches themselves say (a probe that scatters, a part in another place) stays.
[[nodiscard]] bool is_resumable(const core::Error& failure);

/// Executes a plan: opens the cell, qualifies the probe, searches the pose of every feature, and
/// writes each touch into the journal before the next command goes to the machine.
///
/// @return An error when nothing has moved and nothing was written (unreachable target in the start
///         pose, directory in use); otherwise the run, whose journal says how it ended. After a
///         fault the tip was retracted, unless the machine itself had stopped on a collision.
[[nodiscard]] core::Result<Run> run_plan(const Plan& plan, const RunOptions& options);

/// Why a run on record, interrupted or finished, is not the run of this plan and these options: one
/// kMeaning for each difference, as resume_plan() gives them; or the file that cannot be read for
/// the comparison. Empty: it is that run.
[[nodiscard]] std::vector<core::Error> differences_from_run(const record::RunRecord& run,
                                                            const Plan& plan,
                                                            const RunOptions& options);

/// A run that goes on, or why it does not: one error for each thing that changed.
using RunOrRefusals = tl::expected<Run, std::vector<core::Error>>;

/// Goes on with the interrupted run in `options.directory`. The program goes through the journal
/// with the machine at rest (see recorded_run.h); behind the last touch it homes machine and
/// fixture, goes to that touch, repeats it and up to two before it, and continues when none differs
/// by more than the plan's resume_limit_um. The repeated touches enter no result. On a simulated
/// cell the record becomes that of a run without interruption, bit for bit, but for checks and the
/// decision that tells of the interruption.
///
/// With `relocate` a touch on the part that differs by more than the limit does not end the run:
/// the part is located again in that pose and the present cloud, with its repeats, is measured
/// anew; the touches of the earlier placement stay in the journal and enter no result. A run that
/// stood between two clouds ends all the same: what it decided holds for the earlier placement.
///
/// @param options  `seed`, `serial` and `operator_name` may be left out; the run's are kept.
/// @param held  The journal of that directory, which is read this one time.
/// @return  kMeaning for each difference of the plan (`where` its JSON pointer, `what` the old and
///          the new value), of the points files, version, seed, serial number or operator; kJournal
///          for a run that is sealed; the errors of Journal::reopen(). Nothing has moved then, and
///          the journal is as it was.
[[nodiscard]] RunOrRefusals resume_plan(const Plan& plan, const RunOptions& options,
                                        record::HeldJournal held);

}  // namespace rondure::plans
