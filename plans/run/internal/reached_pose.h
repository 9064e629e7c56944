#pragma once

#include <span>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "fixture/kinematics.h"
#include "plans/run/internal/run_context.h"

// Measures the pose of a fixture without encoders: reference spheres that turn with the part show
// the angles set by hand (`fixture.reached_pose` of the plan).

namespace rondure::plans {

/// Steps that touch the spheres on the ring near a pose of the fixture: each from park height down
/// to the pole, around, up again; `row.layer` continues the count of the spheres on the base.
/// @param kinematics  Kinematics of the fixture as far as known.
/// @return Empty without `fixture.reached_pose`; kUnreachable, with the name of the sphere, when
/// the tool would come too close to part, ring, another sphere or another known obstacle. Nothing
/// moves.
[[nodiscard]] core::Result<std::vector<TouchStep>> reached_pose_steps(
    const Plan& plan, const fixture::Kinematics& kinematics, int feature, const core::Pose& asked);

/// The pose in which the spheres were found: least squares of the directions between them, so that
/// position errors of the axes have no effect.
/// @param tips_W_mm  One list of tip centres per sphere, in the order of the plan.
/// @param asked      The commanded pose; of two solutions the closer one is taken.
/// @return kCalibration for a sphere with too much form, or one that does not fit the others; kRank
/// when the spheres do not determine an angle in this pose; kMachine when the pose differs from the
/// commanded one by more than setting_uncertainty_deg.
[[nodiscard]] core::Result<core::Pose> reached_pose(
    const Plan& plan, const fixture::Kinematics& kinematics,
    std::span<const std::vector<Eigen::Vector3d>> tips_W_mm, const core::Pose& asked);

/// Makes and journals the touches. Returns the pose.
[[nodiscard]] core::Result<core::Pose> measure_reached_pose(RunContext& context,
                                                            const std::vector<TouchStep>& steps,
                                                            const core::Pose& asked);

}  // namespace rondure::plans
