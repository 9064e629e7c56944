#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm::ipp {

/// A direction of the part, and where it shall point. Unit vectors.
struct Alignment {
  Eigen::Vector3d part = Eigen::Vector3d::UnitZ();     ///< In the body frame of the table.
  Eigen::Vector3d machine = Eigen::Vector3d::UnitZ();  ///< In the machine frame.
};

/// What stands behind a server: a machine, and what turns the part, if anything does.
class Backend {
 public:
  virtual ~Backend() = default;
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;

  [[nodiscard]] virtual Machine& machine() = 0;

  /// Angles of the table as it reads them, outer axis first [deg]; empty: there is no table.
  [[nodiscard]] virtual std::vector<double> table_angles_deg() const = 0;
  /// References the table, if there is one. The machine is homed before.
  [[nodiscard]] virtual core::Result<void> home_table() = 0;
  /// Turns the part as near to one alignment, or to two at once, as the axes allow.
  /// @return  Where the directions of the part point then, machine frame; kPoseRange when that is
  ///          beyond the limits of the table, kMachine for a fault or without a table.
  [[nodiscard]] virtual core::Result<std::vector<Eigen::Vector3d>> align_part(
      std::span<const Alignment> alignments) = 0;

  // A simulated world can be told where a program stands that went on elsewhere. Not part of I++
  // DME.

  /// Which feature of the part is measured, from 0; kOutOfRange when there are fewer.
  [[nodiscard]] virtual core::Result<void> choose_feature(int index) = 0;
  /// The next turn of the table is this one since homing, counted from 1.
  virtual void set_next_turn(std::uint64_t number) = 0;
};

}  // namespace rondure::cmm::ipp
