#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "plans/cell.h"
#include "plans/plan_reach.h"
#include "plans/pose_search.h"
#include "plans/runner.h"
#include "plans/sampling.h"
#include "plans/travel.h"
#include "record/journal.h"

namespace rondure::plans {

/// What all features of a run share: cell, journal, the numbers of touches and poses, who watches.
struct RunContext {
  const Plan& plan;
  const RunOptions& options;
  Cell* cell;  ///< None when every feature comes from a file.
  record::Journal& journal;
  std::int64_t next_touch = 0;
  int next_pose = 0;
  Progress progress;

  /// kStopped when the operator asked for it.
  [[nodiscard]] core::Result<void> check_stop() const;
  void show() const;
  /// Makes a touch and journals it: `row` says what it is for; number, reading and direction are
  /// filled in. The command's number is set here. Nothing is journalled when it fails.
  [[nodiscard]] core::Result<record::Touch> touch(cmm::TouchCommand command, record::Touch row);
};

/// Moves the tip through the corners of a path given in a frame X (X_WX maps it to the machine).
[[nodiscard]] core::Result<void> follow(cmm::Machine& machine, const Polyline& path,
                                        const Eigen::Isometry3d& X_WX);

/// Straight up to the park height, from above the part or from the reference sphere.
[[nodiscard]] core::Result<void> rise(const Plan& plan, cmm::Machine& machine);

/// One feature in the machine: turns, touches, journals. See PoseSession.
class FeatureSession final : public PoseSession {
 public:
  FeatureSession(RunContext& context, int feature_index, std::vector<Target> targets);

  [[nodiscard]] core::Result<Cloud> measure(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<void> repeat(int times) override;
  [[nodiscard]] core::Result<void> keep_as_final() override;
  [[nodiscard]] core::Result<fit::Axis> locate(const core::Pose& commanded) override;
  [[nodiscard]] bool must_locate() const override;
  [[nodiscard]] core::Pose levelling(const Eigen::Vector3d& direction_W) const override;
  [[nodiscard]] const fixture::FixtureLimits& limits() const override;
  [[nodiscard]] core::Result<void> note(const std::string& text) override;
  void show(double f_mm) override;

 private:
  /// Turns to a pose in which all targets can be reached.
  [[nodiscard]] core::Result<void> turn(const core::Pose& commanded,
                                        const std::vector<Target>& targets);
  /// Touches targets once in the present pose, rises, and gives the tip centres.
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> touch_cloud(
      const std::vector<Target>& targets, record::Touch::Purpose purpose);
  [[nodiscard]] core::Result<Eigen::Vector3d> touch(const Target& target,
                                                    const Eigen::Isometry3d& X_WP,
                                                    record::Touch::Purpose purpose);
  /// The same fault with the point it happened at, and what a person can do about it.
  [[nodiscard]] tl::unexpected<core::Error> fault_at(const Target& target,
                                                     const core::Error& error) const;
  /// From now on targets follow this axis, seen in the present pose.
  void follow_axis(const fit::Axis& axis_W);
  [[nodiscard]] Eigen::Isometry3d part_at(const core::Pose& pose) const;

  RunContext& context_;
  int index_;
  const FeaturePlan& feature_;
  std::vector<Target> targets_;
  Eigen::Isometry3d X_BP_;  ///< Best knowledge of the part in the body frame.
  PathGeometry geometry_;
  core::Pose reached_;
  int pose_id_ = -1;
  int repeat_ = 0;
  int visits_ = 0;
  std::vector<Eigen::Vector3d> truth_;  ///< Noise-free tips of the last first cloud of a pose.
};

}  // namespace rondure::plans
