#pragma once

#include <Eigen/Core>

#include "cmm/error_model.h"

namespace rondure::cmm {

/// True position of the tip for a scale reading at a time: geometry, expansion of the scales about
/// the machine origin, drift.
[[nodiscard]] Eigen::Vector3d true_position(const MachineErrors& errors,
                                            const Eigen::Vector3d& reading_W_mm, double time_s);

/// The reading at a true position: the inverse of true_position(), to 1e-13 mm.
[[nodiscard]] Eigen::Vector3d reading_of(const MachineErrors& errors,
                                         const Eigen::Vector3d& true_W_mm, double time_s);

/// Distance along the approach from the reading at the contact to the reading at the trigger:
/// pre-travel and bending of the stylus. The stylus is parallel to z.
/// @param direction  Unit vector of the approach.
[[nodiscard]] double trigger_delay_mm(const MachineErrors& errors,
                                      const Eigen::Vector3d& direction);

/// Shift of the reading by backlash: half of it, with the sign of the motion, in each axis that
/// moves.
[[nodiscard]] Eigen::Vector3d backlash_shift_mm(const MachineErrors& errors,
                                                const Eigen::Vector3d& direction);

/// Whether any error moves the tip off its commanded path.
[[nodiscard]] bool has_map(const MachineErrors& errors);

}  // namespace rondure::cmm
