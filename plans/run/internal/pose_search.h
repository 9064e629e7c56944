#pragma once

#include "core/message.h"
#include "core/pose.h"
#include "core/result.h"
#include "fit/geometry/axis.h"
#include "fixture/fixture.h"
#include "plans/plan.h"

#include <string>
#include <vector>

namespace rondure::plans {

/// One cloud of tip centres, in the pose the fixture reached.
struct Cloud {
  core::Pose reached;
  std::vector<Eigen::Vector3d> tips_W_mm;
};

/// What a pose search may do with the feature it inspects.
class PoseSession {
 public:
  virtual ~PoseSession() = default;
  PoseSession() = default;
  PoseSession(const PoseSession&) = delete;
  PoseSession& operator=(const PoseSession&) = delete;

  /// Turns to a pose and measures one cloud there. kPoseRange or kUnreachable: nothing has moved.
  [[nodiscard]] virtual core::Result<Cloud> measure(const core::Pose& commanded) = 0;
  /// Turns to a pose and measures there those targets that can be reached: a part of a cloud that
  /// several poses make. kUnreachable, with nothing moved, for fewer than 4 of them.
  [[nodiscard]] virtual core::Result<Cloud> measure_reachable(const core::Pose& commanded) = 0;
  /// All parts of such a cloud are kept.
  [[nodiscard]] virtual core::Result<void> end_merged() = 0;
  /// Measures `times` more clouds in the present pose.
  [[nodiscard]] virtual core::Result<void> repeat(int times) = 0;
  /// The cloud of the present pose, with its repeats, is the one to evaluate.
  [[nodiscard]] virtual core::Result<void> keep_as_final() = 0;
  /// Finds where the part sits, with a few touches in a pose that enter no result; from then on
  /// targets follow the axis found. Gives it, in the machine frame.
  [[nodiscard]] virtual core::Result<fit::Axis> locate(const core::Pose& commanded) = 0;
  /// What to command so that the part turns by a pose of the plan, as far as the errors of the
  /// fixture are known and its limits allow. Levelling poses allow for them already.
  [[nodiscard]] virtual core::Pose commanded_for(const core::Pose& wanted) const { return wanted; }
  /// Whether the plan leaves open where the part sits.
  [[nodiscard]] virtual bool must_locate() const = 0;
  /// Where the axis should point in the present pose: nominal, or as located. Fits start there.
  [[nodiscard]] virtual Eigen::Vector3d expected_axis() const = 0;
  /// The pose that turns a direction seen in the present pose to machine z.
  [[nodiscard]] virtual core::Pose levelling(const Eigen::Vector3d& direction_W) const = 0;
  [[nodiscard]] virtual const fixture::FixtureLimits& limits() const = 0;
  /// Writes a decision into the journal.
  [[nodiscard]] virtual core::Result<void> note(const core::Message& decision) = 0;
  /// Tells whoever watches.
  virtual void show(double f_mm) = 0;
};

/// Runs the pose search of a feature: `guided`, `refined`, `as-published` or `virtual` (DESIGN: the
/// result is always the minimum zone of the final cloud, never the least f met on the way).
/// A circle is located, then measured in its start pose. `merged` is measured in each of its poses
/// and not located: its approach is longer instead.
[[nodiscard]] core::Result<void> search_pose(PoseSession& session, const FeaturePlan& feature);

}  // namespace rondure::plans
