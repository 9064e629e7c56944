#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "plans/run/internal/inspection.h"

namespace rondure::plans {

/// Measures a feature of the type "rotary_axes": turns the fixture through rotary_visits() and
/// touches the balls in each pose, everything journalled before the next step. A touch of ball i
/// has the layer i. Behind the last touch the hidden truth of a simulated fixture is kept, as
/// curves. Evaluation: evaluation/rotary/result.h.
[[nodiscard]] core::Result<void> calibrate_fixture(RunContext& context, int feature_index);

/// How one ball is touched in a pose, from park height and up again; see sphere_steps().
/// @param X_WB  Where the body frame stands in that pose.
[[nodiscard]] core::Result<std::vector<TouchStep>> ball_steps(const Plan& plan, std::size_t feature,
                                                              const Eigen::Isometry3d& X_WB,
                                                              std::size_t ball);

/// Touches that it makes.
[[nodiscard]] std::size_t calibration_touches(const Plan& plan, std::size_t feature);

}  // namespace rondure::plans
