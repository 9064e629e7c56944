#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::cmm {

/// One touch to make. The tip starts at  expected - approach_mm * direction  (the caller has moved
/// it there), searches along `direction` at most to  expected + search_mm * direction, and is back
/// at its start when touch() returns, whatever the outcome.
struct TouchCommand {
  std::int64_t id = 0;  ///< Number of the touch in the journal.
  Eigen::Vector3d expected_tip_W_mm =
      Eigen::Vector3d::Zero();                              ///< Tip centre at the nominal contact.
  Eigen::Vector3d direction_W = -Eigen::Vector3d::UnitX();  ///< Unit vector toward the surface.
  double approach_mm = 3.0;
  double search_mm = 3.0;
};

/// What a touch gave.
struct TouchReading {
  Eigen::Vector3d tip_W_mm =
      Eigen::Vector3d::Zero();     ///< Tip centre at the trigger, machine frame.
  double temperature_degC = 20.0;  ///< Of the part.
  double time_s = 0.0;             ///< Machine clock at the trigger.
};

/// A coordinate measuring machine with a touch probe. Errors: kNoTouch (nothing within the search
/// distance; the tip is back at its start), kCollision (contact during a move; the machine
/// stopped), kMachine (any other fault).
class Machine {
 public:
  virtual ~Machine() = default;
  Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// One line for the record.
  [[nodiscard]] virtual std::string description() const = 0;
  /// References the axes and goes to the park position above everything. First call of a run.
  [[nodiscard]] virtual core::Result<void> home() = 0;
  /// Moves the tip centre in a straight line.
  [[nodiscard]] virtual core::Result<void> move_to(const Eigen::Vector3d& tip_W_mm) = 0;
  [[nodiscard]] virtual core::Result<TouchReading> touch(const TouchCommand& command) = 0;
  /// Tip centre now, machine frame [mm].
  [[nodiscard]] virtual Eigen::Vector3d position_W_mm() const = 0;
  /// Machine clock [s].
  [[nodiscard]] virtual double time_s() const = 0;
};

}  // namespace rondure::cmm
