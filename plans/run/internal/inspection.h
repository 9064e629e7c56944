#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/least_squares/cylinder.h"
#include "plans/cell/cell.h"
#include "plans/forecast/internal/feature_planner.h"
#include "plans/run/internal/past.h"
#include "plans/checks/internal/plan_reach.h"
#include "plans/run/internal/pose_search.h"
#include "plans/run/runner.h"
#include "plans/path/sampling.h"
#include "plans/path/travel.h"
#include "record/journal/journal.h"

namespace rondure::plans {

/// One touch to make and the paths to it, in the machine frame.
struct TouchStep {
  cmm::TouchCommand command;  ///< Its number is set later.
  record::Touch row;          ///< Its purpose; number, reading and direction are set later.
  Polyline entry_W;           ///< From park height to its pre-touch point.
  Polyline way_W;             ///< From the position of the tip to its pre-touch point.
  Polyline aside_W = {};      ///< From there to a start of the touch at another place.
  /// For the first point of a scan: that scan, and its last reading.
  std::optional<cmm::ScanCircleCommand> scan = {};
  cmm::TouchReading scan_end = {};
};

/// One circle to scan and the paths to it.
struct ScanStep {
  cmm::ScanCircleCommand command;  ///< Its number is set later.
  record::Touch row;               ///< Of its points; values that differ among them are set later.
  Polyline entry_W;                ///< As for a touch at its first point.
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
  Past past = {};
  std::vector<TouchStep> last_steps = {};  ///< The last recalled touches of the present cloud.
  bool retreating = false;      ///< The operator refused a motion: go back and up without asking.
  std::string doing = {};       ///< Purpose of the next motions, in words.
  bool relocation_due = false;  ///< The part has moved: locate it, measure the cloud again.
  /// Recovery from an interruption failed: only a person may move the tip.
  bool lost_place = false;

  /// Whether touches come from the journal; nothing moves then.
  [[nodiscard]] bool recalling() const { return past.recalling(next_touch); }
  /// kStopped when the operator has requested it.
  [[nodiscard]] core::Result<void> check_stop() const;
  void show() const;
  /// Makes and journals a touch at the position of the tip, or takes it from the journal. After the
  /// last recorded touch the machine returns to its position (come_back()). A touch that fails is
  /// not journalled.
  [[nodiscard]] core::Result<record::Touch> touch(TouchStep step);
  /// As touch(), for a whole scan: all its points are journalled in one transaction before the next
  /// command. When a run is resumed after it, its first point is touched for comparison.
  [[nodiscard]] core::Result<std::vector<record::Touch>> scan(ScanStep step);
  /// Homes machine and fixture, goes to the last recorded touches and repeats them: kLocation, with
  /// difference and limit, when one has moved; kMachine when the fixture does not read the recorded
  /// pose. Then the tip is at the last of them.
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
  [[nodiscard]] core::Result<void> note(int feature, const std::string& text);

 private:
  [[nodiscard]] core::Result<void> ask(const NextMove& move);
  [[nodiscard]] core::Result<record::Touch> recall(TouchStep step, const record::Touch& known);
  /// The error after the part has moved: kLocation, with relocation_due set if the part may be
  /// located again. @pre The tip is at park height.
  [[nodiscard]] tl::unexpected<core::Error> part_has_moved(const core::Error& error);
  [[nodiscard]] core::Result<std::vector<record::Touch>> recall_scan(ScanStep step);
  /// Adds a step from the journal to those that are checked before the run is resumed; after the
  /// last one, resumes the run.
  [[nodiscard]] core::Result<void> keep_recalled(TouchStep step);
  /// Sets the simulation to its state after a recalled step.
  [[nodiscard]] core::Result<void> recall_state(const TouchStep& step);
  /// Largest difference of two readings of one pose of the fixture.
  [[nodiscard]] double resolution_rad() const;
  /// Repeats a touch. Returns the difference from the recorded one [mm].
  [[nodiscard]] core::Result<double> repeat_touch(const TouchStep& step, std::int64_t check_id);
};

/// A path in another frame (X_WX maps it to the machine).
[[nodiscard]] Polyline in_machine_frame(const Polyline& path, const Eigen::Isometry3d& X_WX);

/// One feature in the machine: turns, touches, journals. See PoseSession.
class FeatureSession final : public PoseSession {
 public:
  FeatureSession(RunContext& context, int feature_index, std::vector<Target> targets);

  [[nodiscard]] core::Result<Cloud> measure(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<Cloud> measure_reachable(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<void> end_merged() override;
  [[nodiscard]] core::Result<void> repeat(int times) override;
  [[nodiscard]] core::Result<void> keep_as_final() override;
  [[nodiscard]] core::Result<fit::Axis> locate(const core::Pose& commanded) override;
  [[nodiscard]] core::Pose commanded_for(const core::Pose& wanted) const override;
  [[nodiscard]] bool must_locate() const override;
  [[nodiscard]] Eigen::Vector3d expected_axis() const override;
  [[nodiscard]] core::Pose levelling(const Eigen::Vector3d& direction_W) const override;
  [[nodiscard]] const fixture::FixtureLimits& limits() const override;
  [[nodiscard]] core::Result<void> note(const std::string& text) override;
  void show(double f_mm) override;

 private:
  /// Whether several poses make the cloud: it cannot be restarted in one of them.
  [[nodiscard]] bool merging() const { return !all_targets_.empty(); }
  /// Stores the truth of this part of such a cloud.
  void keep_merged_truth();
  /// Turns to a pose and touches one cloud; repeats both after each relocation.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> turn_and_touch(
      const core::Pose& commanded);
  /// Locates the part that has moved, in the pose in which that was found.
  [[nodiscard]] core::Result<void> locate_again();
  /// Touches the locating targets in a pose and follows the axis found.
  [[nodiscard]] core::Result<fit::Axis> locate_once(const core::Pose& commanded);
  /// Turns to a pose in which all targets can be reached.
  [[nodiscard]] core::Result<void> turn(const core::Pose& commanded,
                                        const std::vector<Target>& targets);
  /// Touches targets once in the present pose, in the order of the path, and rises. Returns the tip
  /// centres in the order of the targets.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> touch_cloud(
      const std::vector<Target>& targets, record::Touch::Purpose purpose);
  [[nodiscard]] core::Result<Eigen::Vector3d> touch(TouchStep step, const Target& target);
  /// Measures all targets once, as the plan samples them.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> measure_cloud();
  /// Scans the targets layer by layer and rises. Returns the tip centres.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> scan_cloud(
      const std::vector<Target>& targets);
  /// The scan of a whole layer from the k-th target of a path that has one target per layer.
  [[nodiscard]] ScanStep scan_of(const CloudPath& path, std::size_t k, int points) const;
  /// Targets that represent all of them in reach checks.
  [[nodiscard]] std::vector<Target> reach_targets() const;
  /// The path through these targets in a pose. kUnreachable: nothing has moved.
  [[nodiscard]] core::Result<CloudPath> lay(const std::vector<Target>& targets,
                                            const core::Pose& pose);
  /// The step that touches the k-th target of a path, from the one before it or from above.
  [[nodiscard]] TouchStep step_to(const CloudPath& path, std::size_t k,
                                  record::Touch::Purpose purpose) const;
  /// After a refused or failed motion to the k-th target: moves from the pre-touch point at which
  /// the tip is up to the sky.
  void leave(const CloudPath& path, std::size_t k);
  /// The error with its point and the remedy.
  [[nodiscard]] tl::unexpected<core::Error> fault_at(const Target& target,
                                                     const core::Error& error) const;
  /// Checks that a located cylinder can be the part of the plan; otherwise nothing may move on it.
  [[nodiscard]] core::Result<void> check_location(const fit::LsCylinder& found) const;
  /// From now on targets follow this axis, seen in the present pose.
  void follow_axis(const fit::Axis& axis_W);
  [[nodiscard]] Eigen::Isometry3d part_at(const core::Pose& pose) const;

  RunContext& context_;
  int index_;
  const FeaturePlan& feature_;
  std::vector<Target> targets_;
  Eigen::Isometry3d X_BP_;  ///< Best estimate of the part in the body frame.
  PathGeometry geometry_;
  FeaturePlanner planner_;
  core::Pose commanded_;
  core::Pose reached_;
  int pose_id_ = -1;
  int repeat_ = 0;
  int visits_ = 0;
  std::vector<Eigen::Vector3d> truth_;  ///< Noise-free tips of the last first cloud of a pose.
  std::ptrdiff_t truths_ = 0;           ///< Number of final clouds with a truth so far.
  std::vector<Target> all_targets_;     ///< Of a cloud from several poses; otherwise empty.
  std::vector<Eigen::Vector3d> merged_truth_B_;  ///< Its noise-free tips, in the true body frame.
};

}  // namespace rondure::plans
