#pragma once

#include <Eigen/Core>

#include "cmm/machine.h"

namespace rondure::cmm {

// Values sent to and received from a machine lie on a decimal grid, so that they survive a line of
// text with at most 16 digits per number. Each function leaves a value on the grid unchanged.

inline constexpr double kStepsPerMm = 1e10;
inline constexpr double kStepsPerUnit = 1e15;  ///< For the components of a direction.
inline constexpr double kStepsPerDegree = 1e10;
inline constexpr double kStepsPerSecond = 1e9;
inline constexpr double kStepsPerKelvin = 1e6;

[[nodiscard]] Eigen::Vector3d on_grid_mm(const Eigen::Vector3d& p_mm);

/// A direction with its components on the grid; its length is 1 to the last bits. A vector whose
/// length differs from 1 by more than 1e-9 is normalised first.
[[nodiscard]] Eigen::Vector3d direction_on_grid(const Eigen::Vector3d& direction);

/// The angle on the grid in degrees.
[[nodiscard]] double angle_on_grid(double angle_rad);

/// The command as the machine executes it. A command or reading that is not finite stays so.
[[nodiscard]] TouchCommand on_grid(const TouchCommand& command);
[[nodiscard]] ScanCircleCommand on_grid(const ScanCircleCommand& command);
[[nodiscard]] TouchReading on_grid(const TouchReading& reading);

}  // namespace rondure::cmm
