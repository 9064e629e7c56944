#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "wire/line_transport.h"

namespace rondure::cmm::ipp::client {

/// What a server says of itself and its machine when it is asked and nothing moves.
struct Survey {
  /// A number of the active tool, as Tool.PtMeasPar.Approach.
  struct Parameter {
    std::string name;
    std::optional<double> value;
    std::optional<double> least;     ///< Absent: the server names no limit.
    std::optional<double> greatest;  ///< As `least`.
  };
  /// A command that was refused.
  struct Refused {
    std::string command;
    std::string why;
  };

  std::string peer;
  std::string version;                  ///< "" of a server that cannot say: before 1.4.
  std::string machine_class;            ///< "" of a server that cannot say.
  bool tells_state = false;             ///< It knows GetErrStatusE.
  std::string fault;                    ///< What the machine reports; then nothing else was asked.
  std::optional<bool> homed;            ///< Absent: it does not know IsHomed.
  std::vector<std::string> tools;       ///< Without the reserved names that measure nothing.
  std::string tool;                     ///< In the head; "" for none.
  std::optional<double> tip_radius_mm;  ///< Effective, of that tool.
  std::vector<std::string> commands;    ///< Of GetSupportedCommands; empty: it cannot say.
  std::vector<Parameter> parameters;    ///< Those that the server knows.
  std::string frame;                    ///< The active coordinate system; "": it cannot say.
  std::optional<Eigen::Vector3d> tip_mm;  ///< Where the tip stands, in that system.
  std::optional<double> table_deg;        ///< R.
  std::optional<double> part_degC;        ///< Part.Temperature.
  std::vector<std::string> sensors;       ///< Of temperature.
  std::vector<std::string> point_values;  ///< That a touch can report.
  bool scans = false;                     ///< It takes a scan report.
  bool simulated = false;                 ///< It is rondure simulate-cmm.
  std::vector<Refused> refused;

  [[nodiscard]] bool has_rotary_table() const;
  /// Whether the server lists the command, or cannot say what it knows.
  [[nodiscard]] bool may_know(std::string_view command) const;
  /// The parameter with this name, or null.
  [[nodiscard]] const Parameter* parameter(std::string_view name) const;
};

/// Asks a server what it is and can: no motion, no homing, no tool change, and no setting that
/// outlasts the session, which is a new one. The session of somebody else is not ended. A command
/// that the server refuses is taken back (ClearAllErrors) and noted.
/// @param limit  For one answer.
/// @return  kMachine when nobody answers in time, when the answer is none of I++ DME, or when the
///          server serves somebody else.
[[nodiscard]] core::Result<Survey> survey(std::unique_ptr<wire::LineTransport> line,
                                          std::chrono::milliseconds limit);

}  // namespace rondure::cmm::ipp::client
