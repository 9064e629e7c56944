#pragma once

#include <array>
#include <span>
#include <string_view>

#include <Eigen/Core>

#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm {

// Commands and answers held against each other: what may be sent, and whether what came can belong
// to what was sent. A machine that answers something else than it was asked is worse than one that
// does not answer: its points would be evaluated. Limits are wide enough for every machine that
// does what it was told (docs/ipp-dme.md says why each is where it is).

/// Where the tip has to stand before a touch begins.
[[nodiscard]] Eigen::Vector3d start_of(const TouchCommand& command);

/// Why a touch cannot be commanded (kMachine): not finite, a direction that is no unit vector, a
/// search that ends before it starts, or a tip that does not stand at its start to 1e-6 mm.
[[nodiscard]] core::Result<void> check_touch(const TouchCommand& command,
                                             const Eigen::Vector3d& position_W_mm);

/// Why a tip centre cannot be the contact of a touch (kMachine): not finite, before the start or
/// behind the end of the search, or beside its line.
[[nodiscard]] core::Result<void> check_contact(const TouchCommand& command,
                                               const Eigen::Vector3d& tip_W_mm);

/// Why a contact is that of the touch before once more (kMachine): the same to the last digit,
/// although the tip was sent elsewhere.
[[nodiscard]] core::Result<void> check_fresh(const TouchCommand& command,
                                             const Eigen::Vector3d& tip_W_mm,
                                             const TouchCommand& before,
                                             const Eigen::Vector3d& tip_before_W_mm);

/// Why points cannot be those of a scan (kMachine): too few or too many, not finite, off the circle
/// or its plane, the other way round, a part of the sweep missing.
[[nodiscard]] core::Result<void> check_scanned(const ScanCircleCommand& command,
                                               std::span<const Eigen::Vector3d> tips_W_mm);

/// Two directions of the part.
using Directions = std::array<Eigen::Vector3d, 2>;

/// Why two directions cannot be where a part was turned to (kMachine): no unit vectors, not square
/// to each other, or far from where they were to point.
[[nodiscard]] core::Result<void> check_turned(const Directions& asked_W,
                                              const Directions& reached_W);

/// Why the tip cannot stand there after a motion to `target` (kMachine).
/// @param doing  E.g. "the move to the park position".
[[nodiscard]] core::Result<void> check_stands(std::string_view doing,
                                              const Eigen::Vector3d& target_W_mm,
                                              const Eigen::Vector3d& position_W_mm,
                                              double limit_mm);

/// Why a temperature is none of a part or of scales in a room where one measures (kMachine).
/// @param name  As the machine calls it, e.g. "Part.Temperature".
[[nodiscard]] core::Result<void> check_temperature(std::string_view name, double temperature_degC);

/// Why the effective radius of the tip cannot be the known one (kMachine).
[[nodiscard]] core::Result<void> check_tip_radius(double radius_mm, double known_mm,
                                                  double limit_mm);

/// Why a normal is no direction (kMachine). Its length is not used.
[[nodiscard]] core::Result<void> check_normal(const Eigen::Vector3d& normal_W);

}  // namespace rondure::cmm
