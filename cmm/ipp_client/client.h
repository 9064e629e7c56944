#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_client/dialogue.h"
#include "cmm/machine.h"
#include "core/result.h"
#include "wire/transport.h"

namespace rondure::cmm {

/// Settings of a machine that is reached over I++ DME, and the peculiarities of its server.
struct IppMachineOptions {
  std::string tool;  ///< Selected when the machine is homed; "": keep the active tool.
  Eigen::Vector3d park_W_mm = {0.0, 0.0, 500.0};
  Speeds speeds;
  std::chrono::milliseconds answer_limit{5000};    ///< For & and for commands without motion.
  std::chrono::milliseconds motion_limit{120000};  ///< For one motion, homing and tool change.
  bool abort_works = true;          ///< false: a server whose AbortE is broken; see session.h.
  bool returns_to_approach = true;  ///< false: the server refuses a negative Retract.
  ipp::NamedPoint point = ipp::NamedPoint::kSurface;
  ipp::NumberForm numbers = ipp::NumberForm::kSixteenDigits;
  double tip_radius_mm = 0.0;  ///< Nominal radius from the plan; 0: any tool is accepted.
  /// Largest difference of the tip radius of the machine's tool from `tip_radius_mm`.
  double tip_tolerance_mm = 0.1;
  std::function<bool()> stop_requested;  ///< Polled 50 times a second during a motion.
};

/// A coordinate measuring machine that is reached over I++ DME.
///
/// All coordinates are in the frame of the machine (MachineCsy), because servers disagree about the
/// translation of a part frame. Reports are matched by name. The tip is moved to the start of a
/// touch with GoTo; PtMeas receives the expected point of the surface, or the expected tip centre
/// (IppMachineOptions::point), the outward direction and the approach and search distances of the
/// command. After a missing contact the error is cleared and the tip returns to its start. A stop
/// sends AbortE on the fast queue.
///
/// The first touch of a connection shows whether the server means the same point: a negative
/// Retract returns the tip to the start of the search, or, if the server means the other point, to
/// a position one tip radius off. Before that, no touch is made that could collide under either
/// reading. A contradiction is kMeaning. A server that refuses a negative Retract gives no such
/// evidence: PtMeas then stays slow.
///
/// An answer that cannot belong to its command (touch_check.h) is kMachine and blocks every motion
/// until recover().
///
/// Unsolicited reports of the server and those of daemons are never taken for an answer. An error
/// that only refuses a command is cleared; any other error (emergency stop, collision, fault of a
/// drive) blocks every motion until recover(). After the connection is lost, every command is
/// kMachine; recover() connects again.
///
/// time_s() is the time since the connection was opened, unless the server reports its own time
/// with each point; the points of a scan then carry the time of the last touch. Temperatures that
/// the server does not report are absent; see knows_temperature().
class IppMachine final : public Machine {
 public:
  /// Opens the connection; recover() calls it again after a loss.
  using Connect = std::function<core::Result<std::unique_ptr<wire::LineTransport>>()>;

  /// Connects, opens a session and identifies the server. Nothing moves.
  /// @return  kMachine when there is no answer, when it is not from an I++ DME 1.x or 2.x machine,
  ///          or when the machine reports a fault.
  [[nodiscard]] static core::Result<std::unique_ptr<IppMachine>> open(
      Connect connect, const IppMachineOptions& options);

  [[nodiscard]] std::string description() const override;
  [[nodiscard]] Capabilities capabilities() const override;
  [[nodiscard]] core::Result<MachineStatus> status() override;
  [[nodiscard]] core::Result<void> home() override;
  [[nodiscard]] core::Result<void> select_tool(const std::string& name) override;
  [[nodiscard]] core::Result<void> set_speeds(const Speeds& speeds) override;
  [[nodiscard]] core::Result<void> move_to(const Eigen::Vector3d& tip_W_mm) override;
  [[nodiscard]] core::Result<TouchReading> touch(const TouchCommand& command) override;
  [[nodiscard]] core::Result<std::vector<TouchReading>> scan_circle(
      const ScanCircleCommand& command) override;
  void stop() noexcept override { stopped_ = true; }
  [[nodiscard]] core::Result<void> recover() override;
  [[nodiscard]] Eigen::Vector3d position_W_mm() const override { return position_W_mm_; }
  [[nodiscard]] double time_s() const override;

  [[nodiscard]] const ipp::client::Identity& identity() const { return identity_; }
  /// Whether the machine has a rotary table that align_part() can turn.
  [[nodiscard]] bool has_rotary_table() const;
  /// Whether readings carry a measured temperature.
  [[nodiscard]] bool knows_temperature() const { return temperature_degC_.has_value(); }
  /// Whether the server is rondure simulate-cmm, whose noise depends on the numbers of touches and
  /// turns.
  [[nodiscard]] bool is_simulated() const { return identity_.simulated; }
  /// Sends the state of the program to a simulator, e.g. ("Simulation.NextTurn", 3). Sends nothing
  /// to a real machine.
  [[nodiscard]] core::Result<void> tell_simulation(std::string_view name, std::int64_t value);

  /// Where the tip stands in the part system of the control, PartCsy. Everything else is said in
  /// that of the machine, which is chosen again; a failure of that blocks every motion until
  /// recover().
  [[nodiscard]] core::Result<Eigen::Vector3d> tip_in_part_system_mm();

  /// Two directions of the part in the machine frame: target, or result.
  struct Alignment {
    Eigen::Vector3d first_W = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d second_W = Eigen::Vector3d::UnitY();
  };
  /// Turns the tables of the machine so that z of the part points along `target.first_W` and y
  /// along `target.second_W` (AlignPart with 14 numbers, no limits of error).
  /// @return  The directions after the turn.
  [[nodiscard]] core::Result<Alignment> align_part(const Alignment& target);

 private:
  IppMachine(Connect connect, IppMachineOptions options);

  [[nodiscard]] core::Result<void> connect();
  [[nodiscard]] bool is_stop_wanted();
  /// Why a motion did not start: a stop that was not cleared.
  [[nodiscard]] core::Error stopped_before(std::string_view what) const;
  /// Checks the conditions of every motion: a session, no stop, no fault, homed.
  [[nodiscard]] core::Result<void> check_ready();
  [[nodiscard]] core::Result<void> take_tool(const std::string& name);
  /// Checks that the machine names this tool, if it names its tools.
  [[nodiscard]] core::Result<void> check_named(const std::string& tool) const;
  /// Checks that the machine has a tool, with the expected tip.
  [[nodiscard]] core::Result<void> check_tool();
  /// Reads the tip radius that the machine uses; the radius from the plan if it reports none.
  [[nodiscard]] core::Result<void> read_tool_radius();
  /// Sends the number of the next touch to a simulator, so that additional touches do not shift its
  /// noise.
  [[nodiscard]] core::Result<void> number_touch(std::int64_t id);
  [[nodiscard]] core::Result<void> send_speeds();
  [[nodiscard]] core::Result<void> read_speed_limits();
  [[nodiscard]] core::Result<void> read_part_temperature();
  [[nodiscard]] core::Result<bool> scans_with_tool();
  /// Runs a motion. Returns its answer, or the error with the position of the machine.
  [[nodiscard]] core::Result<ipp::client::Reply> run(std::string_view method,
                                                     std::vector<ipp::Item> items, double length_mm,
                                                     const std::string& doing);
  [[nodiscard]] core::Result<void> go_to(const Eigen::Vector3d& tip_W_mm);
  [[nodiscard]] core::Result<void> set_touch_distances(const TouchCommand& command);
  // Conversion between tip centre and the point that the server means: point.cpp.
  // The point to send for a tip centre.
  [[nodiscard]] Eigen::Vector3d named_point(const Eigen::Vector3d& tip_W_mm,
                                            const Eigen::Vector3d& direction_W) const;
  /// Whether a tip could be damaged if the server means the other point. False for a simulator,
  /// which has no real tip and whose clock must show the time of the planned path.
  [[nodiscard]] bool is_cautious() const { return !point_known_ && !identity_.simulated; }
  /// The touch with distances that are safe under either reading.
  [[nodiscard]] TouchCommand for_either_reading(const TouchCommand& command) const;
  /// Distance over which the tip has just moved straight along the line of the touch, and which is
  /// therefore free of obstacles.
  [[nodiscard]] double came_along_mm(const TouchCommand& command) const;
  /// Limits the approach speed of PtMeas to the touch speed, or restores it.
  [[nodiscard]] core::Result<void> slow_down(bool slow);
  /// Checks the position to which the tip returned after `sent`, which is `command` with other
  /// distances.
  [[nodiscard]] core::Result<void> check_point(const TouchCommand& command,
                                               const TouchCommand& sent);
  /// Adds advice to the error of a touch that failed while the point was not yet known.
  [[nodiscard]] core::Error with_point_advice(core::Error error) const;
  [[nodiscard]] core::Result<TouchReading> reading_of(const ipp::client::Reply& reply,
                                                      const TouchCommand& command);
  /// Whether a point can be the answer to a touch (touch_check.h).
  [[nodiscard]] core::Result<void> check_point_of(const ipp::client::PointReport& point,
                                                  const TouchCommand& command) const;
  /// Blocks every motion after an answer that does not belong to its command, because the position
  /// of the tip is then unknown. Returns the error.
  [[nodiscard]] core::Error distrust(const core::Error& error);
  [[nodiscard]] core::Result<std::vector<TouchReading>> readings_of(
      const ipp::client::Reply& reply, const ScanCircleCommand& command);

  Connect connect_;
  IppMachineOptions options_;
  std::unique_ptr<ipp::client::Dialogue> dialogue_;
  ipp::client::Identity identity_;
  std::string tool_;
  Speeds least_;
  Speeds greatest_;
  Eigen::Vector3d position_W_mm_ = Eigen::Vector3d::Zero();
  std::optional<double> temperature_degC_;
  std::optional<double> scale_temperature_degC_;  ///< From the last touch that reported one.
  std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  /// The previous touch and its answer.
  std::optional<std::pair<TouchCommand, Eigen::Vector3d>> last_touch_;
  std::optional<double> effective_radius_mm_;  ///< From the first touch with this tool.
  double server_time_s_ = 0.0;                 ///< From the last point.
  double tool_radius_mm_ = 0.0;                ///< 0: reported by neither machine nor plan.
  bool tool_scans_ = true;                     ///< The active tool has Tool.ScanPar.
  bool point_known_ = false;                   ///< The point that the server means was verified.
  std::array<Eigen::Vector3d, 2> last_move_W_mm_ = {Eigen::Vector3d::Zero(),
                                                    Eigen::Vector3d::Zero()};  ///< Start, end.
  std::int64_t next_touch_ = -1;  ///< Count of a simulator; -1: unknown.
  bool homed_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace rondure::cmm
