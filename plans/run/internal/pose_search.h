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

/// One cloud of tip centres, in the pose that the fixture reached.
struct Cloud {
  core::Pose reached;
  std::vector<Eigen::Vector3d> tips_W_mm;
};

/// The operations of a pose search on the feature it inspects.
class PoseSession {
 public:
  virtual ~PoseSession() = default;
  PoseSession() = default;
  PoseSession(const PoseSession&) = delete;
  PoseSession& operator=(const PoseSession&) = delete;

  /// Turns to a pose and measures one cloud there. kPoseRange or kUnreachable: nothing has moved.
  [[nodiscard]] virtual core::Result<Cloud> measure(const core::Pose& commanded) = 0;
  /// Turns to a pose and measures the reachable targets there: a part of a cloud from several
  /// poses. kUnreachable, with nothing moved, for fewer than 4 of them.
  [[nodiscard]] virtual core::Result<Cloud> measure_reachable(const core::Pose& commanded) = 0;
  /// Measures `times` more clouds in the current pose.
  [[nodiscard]] virtual core::Result<void> repeat(int times) = 0;
  /// Marks the cloud of the current pose, with its repeats, for evaluation.
  [[nodiscard]] virtual core::Result<void> keep_as_final() = 0;
  /// Locates the part with a few touches in a pose that enter no result; from then on targets
  /// follow the located axis. Returns the axis, in the machine frame.
  [[nodiscard]] virtual core::Result<fit::Axis> locate(const core::Pose& commanded) = 0;
  /// The command that turns the part by a pose of the plan, as far as the errors of the fixture are
  /// known and its limits allow. Levelling poses include this correction.
  [[nodiscard]] virtual core::Pose commanded_for(const core::Pose& wanted) const { return wanted; }
  /// Whether the plan leaves the position of the part open.
  [[nodiscard]] virtual bool must_locate() const = 0;
  /// Expected direction of the axis in the current pose: nominal, or as located. Fits start there.
  [[nodiscard]] virtual Eigen::Vector3d expected_axis() const = 0;
  /// The pose that turns a direction seen in the current pose to machine z.
  [[nodiscard]] virtual core::Pose levelling(const Eigen::Vector3d& direction_W) const = 0;
  [[nodiscard]] virtual const fixture::FixtureLimits& limits() const = 0;
  /// Writes a decision into the journal.
  [[nodiscard]] virtual core::Result<void> note(const core::Message& decision) = 0;
  /// Reports f to observers.
  virtual void show(double f_mm) = 0;
};

/// Runs the pose search of a feature: `guided`, `as-published` or `virtual` (DESIGN: the
/// result is always the minimum zone of the final cloud, never the least f found during the
/// search). A circle, and the strategy `start-pose`, is located, then measured in its start pose; a
/// plane, cone or sphere the same without locating. `merged` is measured in each of its poses
/// without locating. Where the part is not located, the approach is longer instead.
[[nodiscard]] core::Result<void> search_pose(PoseSession& session, const FeaturePlan& feature);

}  // namespace rondure::plans
