#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/error_model.h"
#include "cmm/machine.h"
#include "cmm/simulated/part.h"

namespace rondure::cmm {

/// A reference sphere on the table of a simulated machine, a reference column, a hole in a block,
/// or a round flat spot.
struct ReferenceBody {
  enum class Shape { kSphere, kColumn, kHole, kSpot };

  Eigen::Vector3d center_W_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
  Shape shape = Shape::kSphere;
  double half_length_mm = 0.0;                      ///< Of a column or hole.
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< Of what is no sphere; unit vector.
  double wall_mm = kBlockWall_mm;                   ///< Of the block around a hole.
};

/// Settings of a simulated machine.
struct SimulatedMachineOptions {
  double nominal_tip_radius_mm = 2.0;
  Eigen::Vector3d park_W_mm = {0.0, 0.0, 500.0};
  Speeds speeds;
  double temperature_degC = 20.0;
  std::string tool = "T1";         ///< Name of its only tool.
  MachineErrors errors;            ///< Hidden truth.
  PartErrors part_errors;          ///< Hidden truth.
  ScanScatter scan_scatter;        ///< Hidden truth.
  std::uint64_t seed = 1;          ///< Seeds the probe noise and the positions of scanned points.
  std::int64_t lost_at_touch = 0;  ///< The connection is lost at this touch, from 1; 0: never.
};

/// Errors of a good bridge machine of about 1 m with a kinematic touch-trigger probe, in a
/// measuring room. Values and their sources: docs/simulation.md. The repeatability and the ball are
/// ideal: they belong to the probe described in a plan.
[[nodiscard]] MachineErrors typical_errors();

/// A machine in software. It knows the real part and its true position, and finds the true contact
/// of the tip sphere along the approach path as distorted by its errors (machine_map.h). To the
/// reading it adds pre-travel, bending of the stylus, backlash, noise and dust, the last two keyed
/// with (seed, touch id). The errors of the axes apply to searches, but not to moves, which keep
/// clear by millimetres. It stops just before the tip would meet part or reference sphere in a move
/// (kCollision; moves may graze them by 1e-6 mm). A touch that starts in contact is also a
/// kCollision. A command that is not finite, or a touch that does not start at the position of the
/// tip (1e-6 mm), is kMachine and moves nothing. Its volume is a cube of 20 m about the origin.
///
/// A scan touches the surface at every point of its circle, along the radius there; ScanScatter,
/// keyed with (seed, first id), sets the positions of these points.
///
/// The clock advances by distance / speed: travel speed, touch speed along the search, scan speed
/// along the circle, and 0.2 s of settling after each touch and each scan. After the connection is
/// lost every command is kMachine. home() goes straight up to the park height, then across.
class SimulatedMachine final : public Machine {
 public:
  /// The tip is in the park position; nothing moves before home().
  explicit SimulatedMachine(const SimulatedMachineOptions& options);

  /// Puts a part on the table (X_WP maps its frame to the machine), or moves it there.
  void place_part(const SimulatedPart& part, const Eigen::Isometry3d& X_WP);
  void place_part(const PartSurface& surface, const Eigen::Isometry3d& X_WP) {
    place_part(SimulatedPart{{{surface}}}, X_WP);
  }
  void remove_part();
  /// Replaces all reference bodies.
  void place_references(std::vector<ReferenceBody> bodies);

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
  [[nodiscard]] double time_s() const override { return time_s_; }

  // For resumed runs: these restore the state after a command, its clock and its hidden truth, from
  // the readings it gave. They move nothing. When the part cannot have given such readings, the
  // error of the command is returned.

  void continue_at(const Eigen::Vector3d& tip_W_mm, double time_s) {
    position_W_mm_ = tip_W_mm;
    time_s_ = time_s;
  }
  [[nodiscard]] core::Result<void> continue_after(const TouchCommand& command,
                                                  const TouchReading& reading);
  /// @param last  The last reading of the scan.
  [[nodiscard]] core::Result<void> continue_after(const ScanCircleCommand& command,
                                                  const TouchReading& last);

  /// Noise-free tip centre of the last touch: hidden truth for the simulated cell and for tests.
  [[nodiscard]] const Eigen::Vector3d& true_tip_W_mm() const { return true_tips_W_mm_.back(); }
  /// The tip centres of all points of the last scan; one after a touch. Never empty.
  [[nodiscard]] const std::vector<Eigen::Vector3d>& true_tips_W_mm() const {
    return true_tips_W_mm_;
  }

 private:
  /// The first obstacle on a straight line.
  struct Obstacle {
    double travel_mm = 0.0;
    std::optional<ReferenceBody::Shape> reference;  ///< None: it is the part.
    Eigen::Vector3d point_W_mm = Eigen::Vector3d::Zero();
  };

  /// Scale reading at the first contact of a search, before the probe triggers.
  struct Found {
    Eigen::Vector3d reading_W_mm = Eigen::Vector3d::Zero();
    bool on_part = false;
  };

  [[nodiscard]] double tip_radius_mm() const;
  /// The part at its temperature, or nullptr.
  [[nodiscard]] const SimulatedPart* warm_part() const;
  /// @param part  Null: there are only the reference bodies.
  [[nodiscard]] core::Result<Obstacle> first_obstacle(const SimulatedPart* part,
                                                      const Eigen::Vector3d& start_W_mm,
                                                      const Eigen::Vector3d& direction_W,
                                                      double tip_radius_mm,
                                                      double max_travel_mm) const;
  [[nodiscard]] core::Error stop_before(const Obstacle& obstacle, const Eigen::Vector3d& direction,
                                        const Eigen::Vector3d& target_W_mm);
  /// Contact of a machine without errors with the part at 20 degC.
  [[nodiscard]] core::Result<Eigen::Vector3d> true_contact(const TouchCommand& command) const;
  /// Contact of this machine with the part at its temperature, at a time of its clock.
  [[nodiscard]] core::Result<Found> find_contact(const TouchCommand& command, double time_s) const;
  /// The points of a scan at the positions that ScanScatter gives.
  [[nodiscard]] std::vector<TouchCommand> points_of(const ScanCircleCommand& command) const;
  [[nodiscard]] core::Result<std::vector<Found>> find_circle(
      const ScanCircleCommand& command, const std::vector<TouchCommand>& points) const;
  /// The hidden truth of a search; the reading if a machine without errors would meet nothing.
  [[nodiscard]] Eigen::Vector3d truth_of(const TouchCommand& command, const Found& found) const;
  /// The reading of a touch. `time_s` is not yet on the grid.
  [[nodiscard]] TouchReading reading_at(const Found& found, const TouchCommand& touch,
                                        double time_s) const;
  /// Clock time at which a scan that starts now reaches a point.
  [[nodiscard]] double scan_time_s(const ScanCircleCommand& command, int index) const;
  /// Time from one point of a scan to the next.
  [[nodiscard]] double scan_step_s(const ScanCircleCommand& command) const;
  /// Sets the clock to the end of a touch or scan, including the return and the settling.
  void settle(const TouchCommand& command, const TouchReading& reading);
  void settle(const ScanCircleCommand& command, const TouchReading& last);
  /// Checks connection, stop and homing.
  [[nodiscard]] core::Result<void> check_ready() const;
  [[nodiscard]] core::Result<void> check_volume(const Eigen::Vector3d& tip_W_mm) const;
  /// Checks that a search can start: the command is valid, and the tip is at its start.
  [[nodiscard]] core::Result<void> check_command(const TouchCommand& command) const;
  [[nodiscard]] core::Error touch_failed(const core::Error& cause, const TouchCommand& command);
  [[nodiscard]] static core::Error scan_failed(const core::Error& cause,
                                               const ScanCircleCommand& command, int index);

  SimulatedMachineOptions options_;
  std::optional<SimulatedPart> part_;       ///< Part at 20 degC.
  std::optional<SimulatedPart> warm_part_;  ///< Part at its temperature.
  Eigen::Isometry3d X_WP_ = Eigen::Isometry3d::Identity();
  std::vector<ReferenceBody> references_;
  Eigen::Vector3d position_W_mm_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> true_tips_W_mm_ = {Eigen::Vector3d::Zero()};
  double time_s_ = 0.0;
  bool homed_ = false;
  bool lost_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace rondure::cmm
