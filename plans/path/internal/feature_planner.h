#pragma once

#include <vector>

#include "core/result.h"
#include "plans/path/internal/cloud_path.h"

namespace rondure::plans {

/// Plans the paths of the tip for one feature. The scene is built once, and the order of touches is
/// determined once per list of targets. Runs and forecasts use the same planner, so their paths
/// agree.
class FeaturePlanner {
 public:
  FeaturePlanner(const Plan& plan, const FeaturePlan& feature);

  /// @param X_WB  The clamping ring (body frame) in the machine.
  /// @param X_BP  The best estimate of the part in the body frame.
  /// @return kUnreachable with the first unreachable target and the cause.
  [[nodiscard]] core::Result<CloudPath> lay(const std::vector<Target>& targets,
                                            const PathGeometry& geometry,
                                            const Eigen::Isometry3d& X_WB,
                                            const Eigen::Isometry3d& X_BP);

  /// The targets that the tool can reach, in their order.
  [[nodiscard]] std::vector<Target> reachable(const std::vector<Target>& targets,
                                              const PathGeometry& geometry,
                                              const Eigen::Isometry3d& X_WB,
                                              const Eigen::Isometry3d& X_BP) const;

 private:
  const Plan& plan_;
  const FeaturePlan& feature_;
  Scene scene_;
  std::vector<Target> ordered_;  ///< The targets for which `order_` was determined.
  PathGeometry ordered_geometry_;
  std::vector<std::size_t> order_;
};

/// "layer 1, point 3 (102.9 deg): the shaft of the stylus would come nearer than ...".
[[nodiscard]] std::string in_words(const Unreachable& unreachable);

}  // namespace rondure::plans
