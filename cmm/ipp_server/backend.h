#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <tl/expected.hpp>

#include "cmm/ipp/grammar.h"
#include "cmm/machine.h"
#include "core/result.h"

namespace rondure::cmm::ipp {

/// Why a command failed: a number of the error list, and the text for GetXtdErrStatus().
struct Failure {
  int number = 0;
  std::string what;
};

/// Result of a command.
struct Reply {
  std::vector<std::vector<Item>> lines;  ///< Data.
  int report = 0;                        ///< Number of an error to report after the data; 0: none.
};

using Outcome = tl::expected<Reply, Failure>;

/// A direction of the part, and its target direction in the machine. Unit vectors.
struct Alignment {
  Eigen::Vector3d part = Eigen::Vector3d::UnitZ();  ///< Direction in the body frame of the table.
  Eigen::Vector3d machine = Eigen::Vector3d::UnitZ();  ///< Target in the machine frame.
};

/// The equipment of a server: a machine, and a table that turns the part, if there is one.
class Backend {
 public:
  virtual ~Backend() = default;
  Backend() = default;
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;

  [[nodiscard]] virtual Machine& machine() = 0;

  /// Angles of the table as read, outer axis first [deg]; empty: no table.
  [[nodiscard]] virtual std::vector<double> table_angles_deg() const = 0;
  /// References the table, if there is one. @pre The machine is homed.
  [[nodiscard]] virtual core::Result<void> home_table() = 0;
  /// Turns the part as close to one alignment, or to two at once, as the axes allow.
  /// @return  The directions of the part after the turn, machine frame; kPoseRange when it is
  ///          beyond the limits of the table, kMachine for a fault or without a table.
  [[nodiscard]] virtual core::Result<std::vector<Eigen::Vector3d>> align_part(
      std::span<const Alignment> alignments) = 0;

  /// The part as the operator has aligned it in the control: its frame in that of the machine.
  [[nodiscard]] virtual Eigen::Isometry3d part_system() const {
    return Eigen::Isometry3d::Identity();
  }

  // Restore the state of a simulation after an interrupted run. Not part of I++ DME.

  /// Selects the feature of the part to measure, from 0; kOutOfRange beyond the last one.
  [[nodiscard]] virtual core::Result<void> choose_feature(int index) = 0;
  /// Sets the number of the next turn of the table since homing, counted from 1.
  virtual void set_next_turn(std::uint64_t number) = 0;
};

}  // namespace rondure::cmm::ipp
