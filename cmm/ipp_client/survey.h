#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "wire/transport.h"

namespace rondure::cmm::ipp::client {

/// Data that a server reports about itself and its machine without any motion.
struct Survey {
  /// A number of the active tool, e.g. Tool.PtMeasPar.Approach.
  struct Parameter {
    std::string name;
    std::optional<double> value;
    std::optional<double> least;     ///< Absent: the server names no limit.
    std::optional<double> greatest;  ///< Same as `least`.
  };
  /// A command that was refused.
  struct Refused {
    std::string command;
    std::string why;
  };

  std::string peer;
  std::string version;             ///< "" when not reported: before 1.4.
  std::string machine_class;       ///< "" when not reported.
  bool tells_state = false;        ///< The server knows GetErrStatusE.
  std::string fault;               ///< Reported by the machine; no further requests were made then.
  std::optional<bool> homed;       ///< Absent: the server does not know IsHomed.
  std::vector<std::string> tools;  ///< Without the reserved names that cannot measure.
  std::string tool;                ///< Active tool; "" for none.
  std::optional<double> tip_radius_mm;    ///< Effective radius of that tool.
  std::vector<std::string> commands;      ///< From GetSupportedCommands; empty: not reported.
  std::vector<Parameter> parameters;      ///< Those known to the server.
  std::string frame;                      ///< The active coordinate system; "": not reported.
  std::optional<Eigen::Vector3d> tip_mm;  ///< Position of the tip in that system.
  std::optional<double> table_deg;        ///< R.
  std::optional<double> part_degC;        ///< Part.Temperature.
  std::vector<std::string> sensors;       ///< Temperature sensors.
  std::vector<std::string> point_values;  ///< Values that a touch can report.
  bool scans = false;                     ///< The server accepts a scan report.
  bool simulated = false;                 ///< The server is rondure simulate-cmm.
  std::vector<Refused> refused;

  [[nodiscard]] bool has_rotary_table() const;
  /// Whether the server lists the command, or has no list.
  [[nodiscard]] bool may_know(std::string_view command) const;
  /// The parameter with this name, or null.
  [[nodiscard]] const Parameter* parameter(std::string_view name) const;
};

/// Queries a server in a new session: no motion, no homing, no tool change, and no setting that
/// outlasts the session. The session of another client is not ended. A refused command is cleared
/// (ClearAllErrors) and recorded.
/// @param limit  Time limit for one answer.
/// @return  kMachine when no answer arrives in time, when it is not an I++ DME answer, or when the
///          server serves another client.
[[nodiscard]] core::Result<Survey> survey(std::unique_ptr<wire::LineTransport> line,
                                          std::chrono::milliseconds limit);

}  // namespace rondure::cmm::ipp::client
