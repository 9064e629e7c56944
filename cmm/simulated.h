#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "cmm/error_model.h"
#include "cmm/machine.h"
#include "cmm/part_surface.h"

namespace rondure::cmm {

/// What stands on the table of a simulated machine.
struct ReferenceSphere {
  Eigen::Vector3d center_W_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

/// What a simulated machine is told to be.
struct SimulatedMachineOptions {
  double nominal_tip_radius_mm = 2.0;
  Eigen::Vector3d park_W_mm = {0.0, 0.0, 500.0};
  double travel_speed_mm_s = 100.0;
  double touch_speed_mm_s = 5.0;
  double temperature_degC = 20.0;
  MachineErrors errors;            ///< Hidden truth.
  std::uint64_t seed = 1;          ///< Of the probe noise.
  std::int64_t lost_at_touch = 0;  ///< The line breaks at this touch, counted from 1; 0: never.
};

/// A machine that exists in software. It knows the real part and where it really stands, finds the
/// true contact of the tip sphere along the approach line, adds noise keyed with (seed, touch id),
/// and stops just before the tip would meet part or reference sphere in a move (kCollision; moves
/// may graze them by 1e-6 mm). A touch that begins in contact is a kCollision too; a command that
/// is not finite, or a touch that does not begin where the tip stands (1e-6 mm), is kMachine and
/// moves nothing.
///
/// The clock advances by distance / speed: travel speed, touch speed along the search, and 0.2 s of
/// settling after each touch. Once the line is lost every command is kMachine. home() goes straight
/// up to the park height, then across.
class SimulatedMachine final : public Machine {
 public:
  /// The tip stands in the park position.
  explicit SimulatedMachine(const SimulatedMachineOptions& options);

  /// Puts a part on the table (X_WP maps its frame to the machine), or moves it there.
  void place_part(const PartSurface& surface, const Eigen::Isometry3d& X_WP);
  void remove_part();
  void place_sphere(const ReferenceSphere& sphere);

  [[nodiscard]] std::string description() const override;
  [[nodiscard]] core::Result<void> home() override;
  [[nodiscard]] core::Result<void> move_to(const Eigen::Vector3d& tip_W_mm) override;
  [[nodiscard]] core::Result<TouchReading> touch(const TouchCommand& command) override;
  [[nodiscard]] Eigen::Vector3d position_W_mm() const override { return position_W_mm_; }
  [[nodiscard]] double time_s() const override { return time_s_; }

  /// Takes the state that touch() left when it gave this reading, in a run that was interrupted
  /// afterwards: the clock and the hidden truth. Moves nothing. The error of touch() when the part
  /// cannot have given such a reading.
  [[nodiscard]] core::Result<void> continue_after(const TouchCommand& command,
                                                  const TouchReading& reading);

  /// Noise-free tip centre of the last touch: hidden truth for the simulated cell and for tests.
  [[nodiscard]] const Eigen::Vector3d& true_tip_W_mm() const { return true_tip_W_mm_; }

 private:
  /// What the tip meets first on a straight line.
  struct Obstacle {
    double travel_mm = 0.0;
    bool is_sphere = false;
    Eigen::Vector3d point_W_mm = Eigen::Vector3d::Zero();
  };

  [[nodiscard]] double tip_radius_mm() const;
  [[nodiscard]] core::Result<Obstacle> first_obstacle(const Eigen::Vector3d& start_W_mm,
                                                      const Eigen::Vector3d& direction_W,
                                                      double tip_radius_mm,
                                                      double max_travel_mm) const;
  [[nodiscard]] core::Error stop_before(const Obstacle& obstacle, const Eigen::Vector3d& direction,
                                        const Eigen::Vector3d& target_W_mm);
  [[nodiscard]] core::Result<Eigen::Vector3d> true_contact(const TouchCommand& command) const;
  /// Sets the clock to the end of a touch: the way back and the settling.
  void settle(const TouchCommand& command, const TouchReading& reading);
  [[nodiscard]] core::Result<void> check_line() const;
  [[nodiscard]] core::Result<void> check_command(const TouchCommand& command) const;
  [[nodiscard]] core::Error touch_failed(const core::Error& cause, const TouchCommand& command);

  SimulatedMachineOptions options_;
  std::optional<PartSurface> part_;
  Eigen::Isometry3d X_WP_ = Eigen::Isometry3d::Identity();
  std::optional<ReferenceSphere> sphere_;
  Eigen::Vector3d position_W_mm_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d true_tip_W_mm_ = Eigen::Vector3d::Zero();
  double time_s_ = 0.0;
  bool lost_ = false;
};

}  // namespace rondure::cmm
