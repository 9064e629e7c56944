#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "fit/least_squares/cylinder.h"
#include "plans/path/internal/cloud_path.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/sampling.h"
#include "plans/run/internal/pose_search.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// One feature on the machine: turns, touches, journals. See PoseSession.
class FeatureSession final : public PoseSession {
 public:
  FeatureSession(RunContext& context, int feature_index, std::vector<Target> targets);

  [[nodiscard]] core::Result<Cloud> measure(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<Cloud> measure_reachable(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<void> repeat(int times) override;
  [[nodiscard]] core::Result<void> keep_as_final() override;
  [[nodiscard]] core::Result<fit::Axis> locate(const core::Pose& commanded) override;
  /// How much higher than expected, along part z, three touches in the zero pose find a face [mm].
  [[nodiscard]] core::Result<double> locate_height();
  [[nodiscard]] core::Pose commanded_for(const core::Pose& wanted) const override;
  [[nodiscard]] bool must_locate() const override;
  [[nodiscard]] Eigen::Vector3d expected_axis() const override;
  [[nodiscard]] core::Pose levelling(const Eigen::Vector3d& direction_W) const override;
  [[nodiscard]] const fixture::FixtureLimits& limits() const override;
  [[nodiscard]] core::Result<void> note(const core::Message& decision) override;
  void show(double f_mm) override;

 private:
  /// Whether the cloud comes from several poses: it cannot be restarted in one of them.
  [[nodiscard]] bool merging() const { return !all_targets_.empty(); }
  /// Turns to a pose and touches one cloud; repeats both after each relocation.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> turn_and_touch(
      const core::Pose& commanded);
  /// Locates the part again after it has moved, in the pose in which that was detected.
  [[nodiscard]] core::Result<void> locate_again();
  /// Touches the locating targets in a pose and follows the axis found.
  [[nodiscard]] core::Result<fit::Axis> locate_once(const core::Pose& commanded);
  /// Turns to a pose in which all targets can be reached.
  [[nodiscard]] core::Result<void> turn(const core::Pose& commanded,
                                        const std::vector<Target>& targets);
  /// A touch or a scan at the k-th target of a path, with the tip at its pre-touch point.
  using Measure = std::function<core::Result<void>(TouchStep step, std::size_t k)>;
  /// Follows a path from target to target, measures at each, and rises to park height. After a
  /// failure the tip leaves the part, if the machine may move it.
  /// @param by_layer  The path has one target per layer.
  [[nodiscard]] core::Result<void> visit(const CloudPath& path, record::Touch::Purpose purpose,
                                         bool by_layer, const Measure& measure);
  /// Touches targets once in the current pose. Returns the tip centres in the order of the targets.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> touch_cloud(
      const std::vector<Target>& targets, record::Touch::Purpose purpose);
  /// Measures all targets once, as the plan samples them.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> measure_cloud();
  /// Scans the targets layer by layer. Returns the tip centres.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> scan_cloud(
      const std::vector<Target>& targets);
  /// The scan of a whole layer that starts at a touch of its first target.
  [[nodiscard]] ScanStep scan_of(TouchStep first, const Target& start, int points) const;
  /// Targets that represent all of them in reach checks.
  [[nodiscard]] std::vector<Target> reach_targets() const;
  /// The path through these targets in a pose. kUnreachable: nothing has moved.
  [[nodiscard]] core::Result<CloudPath> lay(const std::vector<Target>& targets,
                                            const core::Pose& pose);
  /// The step that touches the k-th target of a path, coming from the one before it or from above.
  [[nodiscard]] TouchStep step_to(const CloudPath& path, std::size_t k,
                                  record::Touch::Purpose purpose) const;
  /// After a refused or failed motion to the k-th target: moves from the pre-touch point at which
  /// the tip is up to the sky.
  void leave(const CloudPath& path, std::size_t k);
  /// The error with its point and the remedy.
  [[nodiscard]] tl::unexpected<core::Error> fault_at(const Target& target,
                                                     const core::Error& error) const;
  /// Checks that the first touch of a part without a fixture, and each that locates it, met it no
  /// farther than location_uncertainty_mm and machine.search_mm from its place in the plan;
  /// otherwise nothing more may move toward it.
  [[nodiscard]] core::Result<void> check_place(const Target& target, const TouchStep& step,
                                               const Eigen::Vector3d& tip_W_mm);
  /// Checks that a located cylinder can be the part of the plan and, without a fixture, that it
  /// stands no farther than location_uncertainty_mm from its place; otherwise nothing may move near
  /// it.
  [[nodiscard]] core::Result<void> check_location(const fit::LsCylinder& found) const;
  [[nodiscard]] core::Result<void> check_displacement(const fit::Axis& found) const;
  /// From now on targets follow this axis, seen in the current pose.
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
  std::vector<Target> all_targets_;  ///< For a cloud from several poses; otherwise empty.
};

}  // namespace rondure::plans
