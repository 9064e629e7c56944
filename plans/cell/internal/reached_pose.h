#pragma once

#include <span>
#include <vector>

#include "core/pose.h"
#include "core/result.h"
#include "fixture/kinematics.h"
#include "plans/run/internal/inspection.h"

// The pose of a fixture without encoders, measured: reference spheres that turn with the part show
// which angles a hand has set (`fixture.reached_pose` of the plan).

namespace rondure::plans {

/// How the spheres on the ring are touched when the fixture stands about in a pose: each from park
/// height down to the pole, around, up again; `row.layer` counts on from the spheres of the base.
/// @param kinematics  As far as the axes of the fixture are known.
/// @param X_BP        Nominal part frame in the body frame.
/// @return Empty without `fixture.reached_pose`; kUnreachable, naming the sphere, when the tool
///         would come too near to part, ring or anything else the plan knows. Nothing moves.
[[nodiscard]] core::Result<std::vector<TouchStep>> reached_pose_steps(
    const Plan& plan, const fixture::Kinematics& kinematics, const Eigen::Isometry3d& X_BP,
    int feature, const core::Pose& asked);

/// The pose in which the spheres were found: least squares of the directions between them, so that
/// errors of the place of the axes do not count.
/// @param tips_W_mm  One list of tip centres a sphere, in the order of the plan.
/// @param asked      The pose that was asked for; of two solutions the one next to it is meant.
/// @return kCalibration for a sphere with too much form, or one that is not where the others put
///         it; kRank when the spheres do not tell an angle in this pose; kMachine when the pose is
///         farther from the asked one than setting_uncertainty_deg.
[[nodiscard]] core::Result<core::Pose> reached_pose(
    const Plan& plan, const fixture::Kinematics& kinematics,
    std::span<const std::vector<Eigen::Vector3d>> tips_W_mm, const core::Pose& asked);

/// Makes the touches, journals them, and gives the pose.
[[nodiscard]] core::Result<core::Pose> measure_reached_pose(RunContext& context,
                                                            const std::vector<TouchStep>& steps,
                                                            const core::Pose& asked);

}  // namespace rondure::plans
