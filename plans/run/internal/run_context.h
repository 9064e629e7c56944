#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/machine.h"
#include "core/message.h"
#include "core/result.h"
#include "plans/cell/cell.h"
#include "plans/path/travel.h"
#include "plans/plan.h"
#include "plans/resume/internal/recorded_run.h"
#include "plans/run_options.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// One touch to make and the paths to it, in the machine frame.
struct TouchStep {
  cmm::TouchCommand command;  ///< Its id is set later.
  record::Touch row;          ///< Holds the purpose; id, reading and direction are set later.
  Polyline entry_W;           ///< Path from park height to its pre-touch point.
  Polyline way_W;             ///< Path from the position of the tip to its pre-touch point.
  Polyline aside_W = {};      ///< Path from there to a start of the touch at another place.
  /// For the first point of a scan: that scan, and its last reading.
  std::optional<cmm::ScanCircleCommand> scan = {};
  cmm::TouchReading scan_end = {};
};

/// One circle to scan and the paths to it.
struct ScanStep {
  cmm::ScanCircleCommand command;  ///< Its ids are set later.
  record::Touch row;  ///< Row of its points; values that differ among them are set later.
  Polyline entry_W;   ///< Path as for a touch at its first point.
  Polyline way_W;
};

/// State shared by all features of a run: cell, journal, the numbers of touches and poses,
/// observers, and the data from before an interruption.
struct RunContext {
  const Plan& plan;
  const RunOptions& options;
  Cell* cell;  ///< Null when every feature comes from a file.
  record::Journal& journal;
  std::int64_t next_touch = 0;
  int next_pose = 0;
  Progress progress = {};
  RecordedRun recorded = {};
  std::vector<TouchStep> last_steps = {};  ///< The last replayed touches of the current cloud.
  bool retreating = false;             ///< The operator refused a motion: retreat without asking.
  std::string doing = {};              ///< Purpose of the next motions, in words.
  bool relocation_due = false;         ///< The part has moved: locate it, measure the cloud anew.
  bool aligned = false;                ///< The part was located as a whole, features need not be.
  bool part_met = false;               ///< A touch has met the part where the plan has it.
  record::PoseVisit last_visit = {};   ///< In which the touches are made.
  std::vector<double> true_tips = {};  ///< Touch, x, y, z: see keep_truth().
  bool lost_place = false;  ///< An interruption was not resolved: only a person may move the tip.

  /// Largest distance of the part from where it is expected.
  [[nodiscard]] double location_mm() const {
    return aligned ? 0.0 : plan.part.location_uncertainty_mm;
  }
  /// Whether touches come from the journal and nothing moves.
  [[nodiscard]] bool replaying() const { return recorded.replaying(next_touch); }
  /// kStopped when the operator has requested a stop.
  [[nodiscard]] core::Result<void> check_stop() const;
  void show() const;
  /// Makes and journals a touch at the position of the tip, or takes it from the journal. After the
  /// last recorded touch the machine returns to its position (come_back()). A touch that fails is
  /// not journalled.
  [[nodiscard]] core::Result<record::Touch> touch(TouchStep step);
  /// touch() for a whole scan: all its points are journalled in one transaction before the next
  /// command. When a run is resumed after it, its first point is touched for comparison.
  [[nodiscard]] core::Result<std::vector<record::Touch>> scan(ScanStep step);
  /// Journals the hidden truth of the touches since the last feature; of a real cell there is none.
  [[nodiscard]] core::Result<void> keep_truth(int feature);
  /// Homes machine and fixture, goes to the last recorded touches and repeats them: kLocation, with
  /// difference and limit, when one has moved; kMachine when the fixture does not read the recorded
  /// pose. The tip is then at the last of these touches.
  [[nodiscard]] core::Result<void> come_back();
  /// kStopped when the operator refuses the motion in a run of single steps.
  [[nodiscard]] core::Result<void> ask_for_homing();
  /// Moves the tip through the corners of a path. When the operator refuses one of the moves, the
  /// tip goes back to the start of the path.
  [[nodiscard]] core::Result<void> follow(const Polyline& path_W);
  /// Straight up to the park height, from above the part or from the reference sphere.
  [[nodiscard]] core::Result<void> rise();
  /// Turns the fixture and journals the pose it reached, or takes both from the journal. kMachine
  /// when it is turned to a recorded pose and does not read the recorded angles.
  [[nodiscard]] core::Result<record::PoseVisit> turn(int feature, const core::Pose& commanded);
  [[nodiscard]] core::Result<void> note(int feature, const core::Message& message);
  /// Has something else clamped before a feature: parks the tip, turns the fixture to its zero
  /// pose, asks, and journals the answer. A simulated cell answers itself. kStopped without an
  /// answer.
  /// @param clamped  Name for the journal.
  /// @param what     What is asked.
  [[nodiscard]] core::Result<void> change_clamping(int feature, const std::string& clamped,
                                                   const std::string& what);

 private:
  [[nodiscard]] core::Result<void> ask(const NextMove& move);
  /// Adds where tips without errors would have stood, the part carried by the nominal axes.
  void note_truth(std::span<const record::Touch> rows);
  /// Journals that the run goes on; the place of the machine is known again.
  [[nodiscard]] core::Result<void> note_return(std::size_t repeated, double largest_mm);
  /// come_back() where the last step was a change of the clamping: nothing is there to repeat.
  [[nodiscard]] core::Result<void> come_back_to_change(double time_s);
  [[nodiscard]] core::Result<record::Touch> replay(TouchStep step, const record::Touch& known);
  /// The error for a part that has moved: kLocation, with relocation_due set if the part may be
  /// located again. The tip is at park height.
  [[nodiscard]] tl::unexpected<core::Error> part_has_moved(const core::Error& error);
  [[nodiscard]] core::Result<std::vector<record::Touch>> replay_scan(ScanStep step);
  /// Adds a replayed step to those repeated before the run continues; after the last replayed step,
  /// continues the run.
  [[nodiscard]] core::Result<void> keep_replayed(TouchStep step);
  /// Sets a simulation to the state after a replayed step.
  [[nodiscard]] core::Result<void> replay_state(const TouchStep& step);
  /// Largest difference between two readings of one pose of the fixture.
  [[nodiscard]] double resolution_rad() const;
  /// Repeats a touch. Returns the difference from the recorded one [mm].
  [[nodiscard]] core::Result<double> repeat_touch(const TouchStep& step, std::int64_t check_id);
};

/// Copies a reading to a row of the journal, and back.
void take_reading(const cmm::TouchReading& reading, record::Touch& row);
[[nodiscard]] cmm::TouchReading reading_of(const record::Touch& row);

}  // namespace rondure::plans
