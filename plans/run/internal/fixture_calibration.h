#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "core/result.h"
#include "plans/run/internal/run_context.h"

namespace rondure::plans {

/// Measures a feature of the type "rotary_axes": turns the fixture through rotary_visits() and
/// touches the balls in each pose. Everything is journalled before the next step. Touches of ball i
/// have layer i. After the last touch the hidden truth of a simulated fixture is stored as curves.
/// Evaluation: evaluation/rotary/result.h.
[[nodiscard]] core::Result<void> calibrate_fixture(RunContext& context, int feature_index);

/// Steps that touch one ball in a pose, from park height and up again; see sphere_steps().
/// @param X_WB  Body frame in that pose.
[[nodiscard]] core::Result<std::vector<TouchStep>> ball_steps(const Plan& plan, std::size_t feature,
                                                              const Eigen::Isometry3d& X_WB,
                                                              std::size_t ball);

/// Number of touches of the calibration.
[[nodiscard]] std::size_t calibration_touches(const Plan& plan, std::size_t feature);

}  // namespace rondure::plans
