#pragma once

#include <string>
#include <vector>

#include "core/result.h"
#include "fit/probe_tip.h"
#include "plans/inspection.h"

namespace rondure::plans {

/// A sphere on the table or on the fixture.
struct SphereToTouch {
  Eigen::Vector3d center_W_mm = Eigen::Vector3d::Zero();  ///< Nominal.
  double radius_mm = 0.0;
  int points = 13;
  double uncertainty_mm = 0.0;  ///< How far it may be off: approach and search are longer by it.
};

/// How a sphere is touched: from park height down to its pole, then around it. kSampling when the
/// points are too few or too many. Purpose and layer of the rows are those of a qualification.
[[nodiscard]] core::Result<std::vector<TouchStep>> sphere_steps(const Plan& plan,
                                                                const SphereToTouch& sphere);

/// Makes the touches of one sphere and rises; the tip centres.
/// @param name  Of the sphere, for messages.
[[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> touch_sphere_steps(
    RunContext& context, const std::vector<TouchStep>& steps, const std::string& name);

/// How the reference sphere of the plan is touched.
[[nodiscard]] core::Result<std::vector<TouchStep>> qualification_steps(const Plan& plan);

/// Touches the reference sphere, journals the touches, and checks the effective tip radius and the
/// probing form against the limits of the plan.
/// @return kCalibration with value and limit when the probe is not fit for measuring.
[[nodiscard]] core::Result<fit::ProbeTip> qualify_probe(RunContext& context);

}  // namespace rondure::plans
