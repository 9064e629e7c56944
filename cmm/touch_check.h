#pragma once

#include <array>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm {

// Checks commands before they are sent, and whether an answer can belong to its command. A machine
// that answers another command is worse than one that does not answer, because its points would be
// evaluated. The limits admit every machine that obeys its commands (docs/ipp-dme.md gives the
// reasons for the limits).

/// The position of the tip at which a touch starts.
[[nodiscard]] Eigen::Vector3d start_of(const TouchCommand& command);

/// Checks a touch before it is sent (kMachine): not finite, a direction that is not a unit vector,
/// a search that ends before it starts, or a tip that is more than 1e-6 mm from its start.
[[nodiscard]] core::Result<void> check_touch(const TouchCommand& command,
                                             const Eigen::Vector3d& position_W_mm);

/// Checks the contact of a touch (kMachine): not finite, before the start or beyond the end of the
/// search, or off its line.
[[nodiscard]] core::Result<void> check_contact(const TouchCommand& command,
                                               const Eigen::Vector3d& tip_W_mm);

/// Checks that a contact is new (kMachine when it repeats the previous touch to the last digit
/// although the tip was sent elsewhere).
[[nodiscard]] core::Result<void> check_fresh(const TouchCommand& command,
                                             const Eigen::Vector3d& tip_W_mm,
                                             const TouchCommand& before,
                                             const Eigen::Vector3d& tip_before_W_mm);

/// Checks the points of a scan (kMachine): too few or too many, not finite, off the circle or its
/// plane, in the opposite sense, a part of the sweep missing.
[[nodiscard]] core::Result<void> check_scanned(const ScanCircleCommand& command,
                                               std::span<const Eigen::Vector3d> tips_W_mm);

/// Two directions of the part.
using Directions = std::array<Eigen::Vector3d, 2>;

/// Checks the directions of a part after a turn (kMachine): not unit vectors, not perpendicular, or
/// far from their targets.
[[nodiscard]] core::Result<void> check_turned(const Directions& asked_W,
                                              const Directions& reached_W);

/// Checks the position of the tip after a motion to `target` (kMachine).
/// @param doing  E.g. "the move to the park position".
[[nodiscard]] core::Result<void> check_stands(std::string_view doing,
                                              const Eigen::Vector3d& target_W_mm,
                                              const Eigen::Vector3d& position_W_mm,
                                              double limit_mm);

/// Checks that a temperature is plausible for a part or scales in a measuring room (kMachine).
/// @param name  Its name on the machine, e.g. "Part.Temperature".
[[nodiscard]] core::Result<void> check_temperature(std::string_view name, double temperature_degC);

/// Checks the effective radius of the tip against the known one (kMachine).
[[nodiscard]] core::Result<void> check_tip_radius(double radius_mm, double known_mm,
                                                  double limit_mm);

/// Checks that a normal is a direction (kMachine). Its length is not used.
[[nodiscard]] core::Result<void> check_normal(const Eigen::Vector3d& normal_W);

}  // namespace rondure::cmm
