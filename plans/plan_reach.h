#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "plans/plan.h"
#include "plans/sampling.h"
#include "plans/travel.h"

namespace rondure::plans {

/// Three numbers of the plan as a vector.
[[nodiscard]] inline Eigen::Vector3d vector3(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// The way of the tip around a feature. `location_mm` is added to approach and clearance while the
/// part is not located.
[[nodiscard]] PathGeometry path_geometry(const Plan& plan, const FeaturePlan& feature,
                                         double location_mm);

/// Targets of a touched feature, if the probe can reach every one of them in the start pose, with
/// the part where the plan says it is.
/// @return kSampling or kUnreachable with the pointer of the feature's sampling. Nothing moves.
[[nodiscard]] core::Result<std::vector<Target>> reachable_targets(const Plan& plan,
                                                                  std::size_t index);

}  // namespace rondure::plans
