#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "core/pose.h"
#include "core/result.h"
#include "plans/plan.h"

namespace rondure::plans {

/// One pose of the calibration of a fixture and the balls that are touched there.
struct RotaryVisit {
  core::Pose pose;
  std::vector<std::size_t> balls;  ///< Indices into the balls of the plan.
};

/// The poses of a feature of the type "rotary_axes" in their order: the zero pose; the stations of
/// the carried axis; the zero pose; those of the base-fixed axis; the combined poses; the zero
/// pose. A station at 0 is one of the zero poses. Each pose lists the balls that the tip can reach:
/// above the rim, and with no part of another ball or sphere of the fixture in the column above
/// them, through which the tip approaches, goes around and leaves.
///
/// @return kUnreachable when a zero pose hides a ball, kCollinear when a pose leaves too few balls,
/// or balls on one line; `where` is the pointer of the balls.
[[nodiscard]] core::Result<std::vector<RotaryVisit>> rotary_visits(const Plan& plan,
                                                                   std::size_t feature);

/// Ball centres in a pose according to the nominal kinematics, machine frame.
[[nodiscard]] std::vector<Eigen::Vector3d> ball_centers_W(const Plan& plan, std::size_t feature,
                                                          const core::Pose& pose);

}  // namespace rondure::plans
