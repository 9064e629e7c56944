#pragma once

#include <Eigen/Core>

#include "cmm/error_model.h"

namespace rondure::cmm {

/// Where the tip really is minus where the scales say, at a reading: the 21 parametric errors of a
/// bridge machine whose y axis carries x, which carries z, which carries the probe. Rigid bodies,
/// small angles:
///   e = sum over the axes k of  t_k + r_k x L_k  +  squareness,
///   q = reading - tip offset (positions of the axes),
///   L_z = tip offset, L_x = L_z + (0, 0, q_z), L_y = L_x + (q_x, 0, 0).
/// With axes that are not square, x the reference:
///   (-xy q_y - xz q_z,  -yz q_z,  0).
/// Sources: ISO 230-1:2012 (names and signs); G. Zhang et al., "Error compensation of coordinate
/// measuring machines", CIRP Annals 34(1), 1985; H. Schwenk et al., "Geometric error measurement
/// and compensation of machines - an update", CIRP Annals 57(2), 2008.
[[nodiscard]] Eigen::Vector3d geometric_error_mm(const GeometricErrors& errors,
                                                 const Eigen::Vector3d& reading_W_mm);

/// Where the tip really is when the scales read so at a time: geometry, expansion of the scales
/// about the machine origin, drift.
[[nodiscard]] Eigen::Vector3d true_position(const MachineErrors& errors,
                                            const Eigen::Vector3d& reading_W_mm, double time_s);

/// The reading at a true position: the inverse of true_position(), to 1e-13 mm.
[[nodiscard]] Eigen::Vector3d reading_of(const MachineErrors& errors,
                                         const Eigen::Vector3d& true_W_mm, double time_s);

/// How far the reading at the trigger lies along the approach behind that at the contact:
/// pre-travel and bending of the stylus. The stylus stands along z.
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
