#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/pose.h"
#include "core/result.h"
#include "plans/plan.h"
#include "record/growing_record.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// Where a run stands, for whoever watches.
struct Progress {
  std::string feature;
  int pose_number = 0;               ///< From 1, within the feature.
  core::Pose pose;                   ///< As the fixture reads it.
  std::size_t touches = 0;           ///< Done, in the whole run.
  std::size_t touches_expected = 0;  ///< Estimate for the whole run.
  double time_s = 0.0;               ///< Machine clock at the last touch.
  std::optional<double> f_mm;        ///< Least zone of the last complete cloud in its pose.
};

/// A motion that comes next, for whoever follows a run step by step.
struct NextMove {
  enum class Kind { kHome, kMove, kTouch, kTurn };
  Kind kind = Kind::kMove;
  std::string what;  ///< In words, e.g. "layer 1, point 2: move".
  /// Tip centre before and after, machine frame; the expected contact of a touch. Only of kMove and
  /// kTouch.
  Eigen::Vector3d from_W_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_W_mm = Eigen::Vector3d::Zero();
};

/// Everything about a run that does not stand in the plan.
struct RunOptions {
  std::filesystem::path directory;  ///< Is made; must be absent or empty. Of a run to resume: its.
  std::string run_id;
  std::string plan_file;  ///< Name for the record.
  std::string serial;
  std::string operator_name;
  std::string started_utc;  ///< Of this start, also of a resumed run. For the record only.
  std::string processor;
  std::optional<std::uint64_t> seed;     ///< Takes the place of the plan's.
  std::filesystem::path wire_log;        ///< Of what goes to a machine and comes; "": none.
  std::function<bool()> stop_requested;  ///< Asked before every touch, and while a machine moves.
  std::function<void(const Progress&)> progress;
  std::shared_ptr<record::GrowingRecord> followed_by;  ///< Gets what the journal holds; or none.
  /// Asked before each motion; an error (kStopped) ends the run: the tip goes back on the way it
  /// came, without asking, and up. Not asked for motions that a fault makes necessary.
  std::function<core::Result<void>(const NextMove&)> before_move;
  /// Asks a person to set a pose of a fixture "manual" in front of a real machine.
  std::function<core::Result<void>(const core::Pose&)> set_by_hand;
  bool relocate = false;     ///< Of a run to resume: a part that has moved is located again.
  bool single_step = false;  ///< A first run: travels at the plan's step_speed_mm_s at most.
};

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
