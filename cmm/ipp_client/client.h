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

#include "cmm/ipp_client/dialogue.h"
#include "cmm/ipp/named_point.h"
#include "cmm/machine.h"
#include "core/result.h"
#include "wire/line_transport.h"

namespace rondure::cmm {

/// How a machine behind I++ DME is used, and what is special about its server.
struct IppMachineOptions {
  std::string tool;  ///< Taken when the machine is homed; "": the tool that is active stays.
  Eigen::Vector3d park_W_mm = {0.0, 0.0, 500.0};
  Speeds speeds;
  std::chrono::milliseconds answer_limit{5000};    ///< For & and for commands that move nothing.
  std::chrono::milliseconds motion_limit{120000};  ///< For one motion, homing and tool change.
  bool abort_works = true;  ///< false: a server whose AbortE is broken; see ipp_client_session.h.
  bool returns_to_approach = true;  ///< false: a server that refuses a negative Retract.
  ipp::NamedPoint point = ipp::NamedPoint::kSurface;
  ipp::NumberForm numbers = ipp::NumberForm::kSixteenDigits;
  double tip_radius_mm = 0.0;            ///< Nominal, of the tip in the plan; 0: any tool will do.
  double tip_tolerance_mm = 0.1;         ///< How far the tool of the machine may be off.
  std::function<bool()> stop_requested;  ///< Asked 50 times a second while something moves.
};

/// A coordinate measuring machine that is reached over I++ DME.
///
/// Everything is said in the frame of the machine (MachineCsy): servers disagree about the
/// translation of a part frame. Reports are matched by name. The tip is moved to the start of a
/// touch with GoTo; PtMeas gets the expected point of the surface, or the expected tip centre
/// (IppMachineOptions::point), the outward direction and the approach and search distances of the
/// command. After a contact was not found the error is taken back and the tip goes back to its
/// start. A stop sends AbortE on the fast queue.
///
/// Whether the server means the same point shows after the first touch of a connection: a negative
/// Retract brings the tip back to the start of the search, which is one tip radius off where it
/// does not. Up to then no touch is made that could collide under either reading. A contradiction
/// is kMeaning. A server that refuses a negative Retract shows nothing: then PtMeas stays slow.
///
/// An answer that cannot belong to what was asked (touch_check.h) is kMachine and keeps every
/// motion back until recover().
///
/// What the server reports without having been asked, and what a daemon sends, is never taken for
/// an answer. An error that only refuses a command is taken back; any other one (emergency stop,
/// collision, fault of a drive) keeps every motion back until recover(). When the connection is
/// lost every command is kMachine; recover() connects again.
///
/// time_s() is the time since the connection was opened, unless the server gives its own with each
/// point; the points of a scan carry the time of the last touch then. Temperatures that the
/// server does not give are absent; see knows_temperature().
class IppMachine final : public Machine {
 public:
  /// Makes the connection; also called by recover() when it was lost.
  using Connect = std::function<core::Result<std::unique_ptr<wire::LineTransport>>()>;

  /// Connects, opens a session and asks who answers. Nothing moves.
  /// @return  kMachine when nobody answers, or not as a machine of I++ DME 1.x or 2.x, or when the
  ///          machine reports a fault.
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
  /// Whether readings carry a temperature that was measured.
  [[nodiscard]] bool knows_temperature() const { return temperature_degC_.has_value(); }
  /// Whether rondure simulate-cmm answers, whose noise is that of numbered touches and turns.
  [[nodiscard]] bool is_simulated() const { return identity_.simulated; }
  /// Tells a simulator where the program stands, e.g. ("Simulation.NextTurn", 3). Nothing is said
  /// to a real machine.
  [[nodiscard]] core::Result<void> tell_simulation(std::string_view name, std::int64_t value);

  /// Two directions of the part and where they shall point, or where they do point.
  struct Alignment {
    Eigen::Vector3d first_W = Eigen::Vector3d::UnitZ();
    Eigen::Vector3d second_W = Eigen::Vector3d::UnitY();
  };
  /// Turns the tables of the machine so that z of the part points along `target.first_W` and y
  /// along `target.second_W` (AlignPart with 14 numbers, no limits of error).
  /// @return  Where both point then.
  [[nodiscard]] core::Result<Alignment> align_part(const Alignment& target);

 private:
  IppMachine(Connect connect, IppMachineOptions options);

  [[nodiscard]] core::Result<void> connect();
  [[nodiscard]] bool is_stop_wanted();
  /// Why a motion did not begin: a stop that was not taken back.
  [[nodiscard]] core::Error stopped_before(std::string_view what) const;
  /// What every motion needs: a session, no stop, no fault, homed.
  [[nodiscard]] core::Result<void> check_ready();
  [[nodiscard]] core::Result<void> take_tool(const std::string& name);
  /// That the machine names this tool, where it names its tools.
  [[nodiscard]] core::Result<void> check_named(const std::string& tool) const;
  /// That the machine has a tool, and one whose tip is the expected one.
  [[nodiscard]] core::Result<void> check_tool();
  /// The radius the machine works with, that of the plan where it tells none.
  [[nodiscard]] core::Result<void> read_tool_radius();
  /// Touches of a simulator have numbers; what came between must not shift them.
  [[nodiscard]] core::Result<void> number_touch(std::int64_t id);
  [[nodiscard]] core::Result<void> send_speeds();
  [[nodiscard]] core::Result<void> read_speed_limits();
  [[nodiscard]] core::Result<void> read_part_temperature();
  [[nodiscard]] core::Result<bool> scans_with_tool();
  /// A motion: its answer, or the error with the place where the machine stands.
  [[nodiscard]] core::Result<ipp::client::Reply> run(std::string_view method,
                                                     std::vector<ipp::Item> items, double length_mm,
                                                     const std::string& doing);
  [[nodiscard]] core::Result<void> go_to(const Eigen::Vector3d& tip_W_mm);
  [[nodiscard]] core::Result<void> set_touch_distances(const TouchCommand& command);
  // Which point the server means: ipp_client_point.cpp.
  /// The point to name for a tip centre.
  [[nodiscard]] Eigen::Vector3d named_point(const Eigen::Vector3d& tip_W_mm,
                                            const Eigen::Vector3d& direction_W) const;
  /// Whether a tip could come to harm by the other reading. A simulator has none to lose, and its
  /// clock is to show the time of the planned path.
  [[nodiscard]] bool is_cautious() const { return !point_known_ && !identity_.simulated; }
  /// The touch with distances that suit either reading.
  [[nodiscard]] TouchCommand for_either_reading(const TouchCommand& command) const;
  /// How far the tip has just come straight in along the line of the touch: this way is free.
  [[nodiscard]] double came_along_mm(const TouchCommand& command) const;
  /// Approaches of PtMeas itself are made no faster than a touch, or as fast as others again.
  [[nodiscard]] core::Result<void> slow_down(bool slow);
  /// Looks where the tip came back to after `sent`, the touch `command` with other distances.
  [[nodiscard]] core::Result<void> check_point(const TouchCommand& command,
                                               const TouchCommand& sent);
  /// A failed touch while the reading is not known.
  [[nodiscard]] core::Error with_point_advice(core::Error error) const;
  [[nodiscard]] core::Result<TouchReading> reading_of(const ipp::client::Reply& reply,
                                                      const TouchCommand& command);
  /// Whether a point can be the answer to a touch (touch_check.h).
  [[nodiscard]] core::Result<void> check_point_of(const ipp::client::PointReport& point,
                                                  const TouchCommand& command) const;
  /// Keeps the machine still after an answer that does not belong to what was asked: where its tip
  /// stands is not known either. Gives the error.
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
  std::optional<double> scale_temperature_degC_;  ///< Of the last touch that came with one.
  std::chrono::steady_clock::time_point opened_ = std::chrono::steady_clock::now();
  /// The touch before, and its answer.
  std::optional<std::pair<TouchCommand, Eigen::Vector3d>> last_touch_;
  std::optional<double> effective_radius_mm_;  ///< Of the first touch with this tool.
  double server_time_s_ = 0.0;                 ///< Of the last point.
  double tool_radius_mm_ = 0.0;                ///< 0: neither machine nor plan tell one.
  bool tool_scans_ = true;                     ///< The active tool has Tool.ScanPar.
  bool point_known_ = false;                   ///< What the server means by a point was seen.
  std::array<Eigen::Vector3d, 2> last_move_W_mm_ = {Eigen::Vector3d::Zero(),
                                                    Eigen::Vector3d::Zero()};  ///< From, to.
  std::int64_t next_touch_ = -1;  ///< As a simulator counts; -1: not known.
  bool homed_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace rondure::cmm
