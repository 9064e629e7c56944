#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/grid.h"
#include "core/pose.h"
#include "core/result.h"
#include "fixture/fixture.h"
#include "fixture/kinematics.h"
#include "plans/path/obstacle.h"
#include "plans/path/sampling.h"
#include "plans/path/travel.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Three numbers of the plan as a vector.
[[nodiscard]] inline Eigen::Vector3d vector3(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

/// The axes of the fixture as stated in the plan.
[[nodiscard]] fixture::Kinematics nominal_kinematics(const FixturePlan& fixture);

/// Distance of two places of the base, seen from above [mm].
[[nodiscard]] inline double apart_mm(const std::array<double, 3>& a,
                                     const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}
/// Between the edges of two holes or dowels; negative where they overlap [mm].
[[nodiscard]] inline double between_mm(const DatumHolePlan& a, const DatumHolePlan& b) {
  return apart_mm(a.center_mm, b.center_mm) - 0.5 * (a.diameter_mm + b.diameter_mm);
}

/// Least distance of two parallel lines that enclose the seat of the base [mm].
[[nodiscard]] double seat_width_mm(const DatumPlan& datum);

/// How far the base may lean while its seat is within uncertainty_mm of its place; 0 for spheres.
[[nodiscard]] double most_lean_rad(const DatumPlan& datum);

/// The position of the part in the clamping ring as stated in the plan: X_BP.
[[nodiscard]] Eigen::Isometry3d nominal_seat(const FixturePlan& fixture);

/// A body of the plan in its frame.
[[nodiscard]] Eigen::Isometry3d placed_body(const BodyPlan& body);

/// Corners, in its frame, whose convex hull contains a body.
[[nodiscard]] std::vector<Eigen::Vector3d> corners_of(const BodyPlan& body);

/// Where the plan has a part without a fixture: X_WP.
[[nodiscard]] Eigen::Isometry3d standing_part(const FixturePlan& fixture);

[[nodiscard]] fixture::FixtureLimits limits_of(const FixturePlan& fixture);

/// The pose in which the measurement of a feature starts.
[[nodiscard]] core::Pose start_pose(const FeaturePlan& feature);

/// Poses sent to and read from a fixture are on a grid of 1e-10 deg, so that a turn sent as
/// directions in a line of I++ DME equals a turn inside the program to the last bit.
[[nodiscard]] inline core::Pose on_grid(const core::Pose& pose) {
  return {cmm::angle_on_grid(pose.alpha_rad), cmm::angle_on_grid(pose.beta_rad)};
}

/// A pose for messages: "(12.3400, 0.0000) deg".
[[nodiscard]] std::string in_degrees(const core::Pose& pose, int decimals = 4);

/// A piece of the part as a solid, part frame.
struct PartPiece {
  Eigen::Vector3d origin_mm = Eigen::Vector3d::Zero();
  Revolved solid;

  [[nodiscard]] double from_mm() const;
  [[nodiscard]] double to_mm() const;
  [[nodiscard]] double radius_mm() const;  ///< Greatest distance from the part axis.
};

/// The solid behind the surface of a feature: a shaft, the block around a bore, the frustum of a
/// cone, a ball, a thin disc behind a plane.
[[nodiscard]] PartPiece piece_of(const FeaturePlan& feature);

/// The part beside a feature: the sections of the plan, and the other touched outside surfaces
/// (not for a bore, whose block hides them), of cylinders those above or below it.
[[nodiscard]] std::vector<PartPiece> part_beside(const Plan& plan, const FeaturePlan& feature);

/// The path geometry of a feature. Shoulders, and a ring of known size, above the lower end of a
/// shaft increase the radius of the path around it. `location_mm` is added to approach and
/// clearance while the part is not located.
[[nodiscard]] PathGeometry path_geometry(const Plan& plan, const FeaturePlan& feature,
                                         double location_mm);

/// Checks that no target on a shaft lies in or below the clamped band of a ring of unknown size:
/// the tip comes from above and cannot pass it.
/// @return kUnreachable with layer and point (from 1), height and limit.
[[nodiscard]] core::Result<void> check_clamp(const std::vector<Target>& targets,
                                             const PathGeometry& geometry,
                                             const FixturePlan& fixture);

}  // namespace rondure::plans
