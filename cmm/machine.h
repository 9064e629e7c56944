#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"

namespace rondure::cmm {

// The contract of every coordinate measuring machine with a touch probe.
// tests/cmm/machine_contract.h checks each driver against it.
//
// Frames: W is the machine frame. Every position is the centre of the tip, never a surface point.
// Units: mm, mm/s, s, rad, degC.
// Numbers: positions are on a grid of 1e-10 mm and directions on one of 1e-15 (grid.h), in commands
// and in results, because a line of I++ DME carries at most 16 digits: a run over a socket then
// gives the bits of the run in one process.

/// One touch to make. The tip starts at  expected - approach_mm * direction  (the caller has moved
/// it there, to 1e-6 mm), searches along `direction` at most to  expected + search_mm * direction,
/// and is back at its start when touch() returns, whatever the outcome.
struct TouchCommand {
  std::int64_t id = 0;  ///< Number of the touch in the journal.
  Eigen::Vector3d expected_tip_W_mm =
      Eigen::Vector3d::Zero();                              ///< Tip centre at the nominal contact.
  Eigen::Vector3d direction_W = -Eigen::Vector3d::UnitX();  ///< Unit vector toward the surface.
  double approach_mm = 3.0;
  double search_mm = 3.0;
};

/// Result of a touch, or of one point of a scan.
struct TouchReading {
  Eigen::Vector3d tip_W_mm =
      Eigen::Vector3d::Zero();             ///< Tip centre at the trigger, machine frame, as read.
  std::optional<double> temperature_degC;  ///< Part temperature; none: not measured.
  double time_s = 0.0;                     ///< Machine clock at the trigger.
  double tip_radius_mm = 0.0;  ///< Effective radius the machine works with; 0: not reported.
  /// Temperature of the machine scales; none: not measured.
  std::optional<double> scale_temperature_degC;
};

/// One circle to scan on a round surface, at the scan speed.
///
/// With c the centre, n the axis, s the start: the tip centre is expected on the circle about c
/// normal to n through s, and runs from s through `sweep_rad` about n (right-handed). Point i of n
/// lies at the angle  sweep * i / points  from s. The tip starts `approach_mm` off the surface at s
/// (outside: away from c; inside: toward c), as for a touch; when scan_circle() returns, it is that
/// far off at the end of the sweep, or, after kNoTouch, where it started.
struct ScanCircleCommand {
  std::int64_t first_id = 0;  ///< Number of the first point in the journal; the others follow on.
  Eigen::Vector3d center_W_mm = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();  ///< Unit vector.
  Eigen::Vector3d start_tip_W_mm =
      Eigen::Vector3d::UnitX();  ///< Tip centre at the nominal contact of the first point.
  bool inside = false;           ///< The surface surrounds the tip.
  double sweep_rad = 0.0;        ///< May exceed one revolution; negative: clockwise about the axis.
  int points = 0;                ///< 3..kMaxScanPoints; a real machine may give a few more or less.
  double approach_mm = 3.0;
  double search_mm = 3.0;  ///< Largest distance of the surface beyond the circle before it is lost.
};

/// Points of one scan, at most.
inline constexpr int kMaxScanPoints = 100'000;

/// Speeds [mm/s].
struct Speeds {
  double travel_mm_s = 100.0;
  double touch_mm_s = 5.0;  ///< While searching the surface.
  double scan_mm_s = 10.0;  ///< Tip speed along a scanned circle.

  friend bool operator==(const Speeds&, const Speeds&) = default;
};

/// Capabilities of a machine.
struct Capabilities {
  std::string name;  ///< Name that the machine reports.
  bool scans_circles = false;
  std::string no_scans;            ///< Reason, if the machine gives one.
  Speeds least;                    ///< Slowest speeds it accepts.
  Speeds greatest;                 ///< Fastest.
  std::vector<std::string> tools;  ///< Names for select_tool().
  Eigen::Vector3d volume_min_W_mm =
      Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector3d volume_max_W_mm =
      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
};

/// State of a machine.
struct MachineStatus {
  bool homed = false;
  bool stopped = false;  ///< stop() was called; recover() clears this.
  std::string tool;      ///< Active tool; "": none.
  std::string fault;     ///< Reported by the machine; "": none.
};

/// A coordinate measuring machine. A command that is refused moves nothing.
///
/// Errors, of every command:
///   kNoTouch      nothing within the search distance; the tip is back at its start
///   kCollision    contact during a move, or before a search; the machine stopped where it was
///   kUnreachable  a target outside the volume; no motion
///   kStopped      stop() was called; the motion has ended
///   kMachine      any other fault: not homed, a command that is not finite or invalid, tool
///                 unknown, line lost; `what` holds the message of the machine
class Machine {
 public:
  virtual ~Machine() = default;
  Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  /// One line for the record.
  [[nodiscard]] virtual std::string description() const = 0;
  [[nodiscard]] virtual Capabilities capabilities() const = 0;
  [[nodiscard]] virtual core::Result<MachineStatus> status() = 0;

  /// References the axes and goes to the park position above all obstacles. Must be the first call
  /// of a run: without it every motion is kMachine.
  [[nodiscard]] virtual core::Result<void> home() = 0;
  /// Takes a tool by its name; moves to a rack where the machine has one. kMachine, with the names
  /// of its tools, for an unknown name.
  [[nodiscard]] virtual core::Result<void> select_tool(const std::string& name) = 0;
  /// kOutOfRange, with the limit, when one of the speeds is beyond it; then none is changed.
  [[nodiscard]] virtual core::Result<void> set_speeds(const Speeds& speeds) = 0;

  /// Moves the tip centre in a straight line.
  [[nodiscard]] virtual core::Result<void> move_to(const Eigen::Vector3d& tip_W_mm) = 0;
  [[nodiscard]] virtual core::Result<TouchReading> touch(const TouchCommand& command) = 0;
  /// Scans a circle. Returns the readings in order along it. kMachine when the machine cannot scan,
  /// or points or sweep are out of range. The readings of a failed scan are discarded.
  [[nodiscard]] virtual core::Result<std::vector<TouchReading>> scan_circle(
      const ScanCircleCommand& command) = 0;

  /// Ends the motion in progress, whose command returns kStopped, as does every later motion until
  /// recover(). May be called from a signal handler and from another thread; returns at once.
  virtual void stop() noexcept = 0;
  /// Clears a stop, or a fault that can be cleared by command; moves nothing. kMachine, with the
  /// message of the machine, when the fault stays.
  [[nodiscard]] virtual core::Result<void> recover() = 0;

  /// Tip centre now, machine frame [mm].
  [[nodiscard]] virtual Eigen::Vector3d position_W_mm() const = 0;
  /// Machine clock [s].
  [[nodiscard]] virtual double time_s() const = 0;
};

}  // namespace rondure::cmm
