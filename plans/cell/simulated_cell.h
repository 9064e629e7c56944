#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/grid.h"
#include "cmm/simulated/machine.h"
#include "fixture/simulated.h"
#include "plans/cell/cell.h"

namespace rondure::plans {

/// Machine and part in software, with a simulated or a real fixture. The simulated machine does not
/// know how the fixture moves the part; the cell places the part after every turn. With a real
/// fixture the part in software follows the angles that it reads, with the errors that the plan
/// simulates.
class SimulatedCell final : public Cell {
 public:
  /// Opens the simulated cell of a plan that has `machine`, `fixture`, `probe` and `simulation`.
  /// @param seed     Seed of all noise; replaces the seed of the plan.
  /// @param resumed  The simulated faults have already occurred.
  /// @param driven   A real fixture; nullptr: a simulated one.
  SimulatedCell(const Plan& plan, std::uint64_t seed, bool resumed,
                std::unique_ptr<fixture::Fixture> driven = nullptr);

  [[nodiscard]] fixture::Fixture& fixture() override {
    return driven_ ? *driven_ : static_cast<fixture::Fixture&>(fixture_);
  }
  [[nodiscard]] cmm::Machine& machine() override { return machine_; }

  [[nodiscard]] bool is_simulated() const override { return true; }

  /// The frame of the part as it truly stands in the zero pose, without the tilt and the offset of
  /// its seat: what an operator would have aligned in the control.
  [[nodiscard]] Eigen::Isometry3d part_system() const {
    return true_X_WF_ * fixture_.true_body_to_machine() * nominal_part();
  }
  [[nodiscard]] core::Result<Eigen::Vector3d> tip_in_part_system_mm() override {
    return Eigen::Vector3d(part_system().inverse() * machine_.position_W_mm());
  }

  /// Clamps the part with this feature.
  void mount(const FeaturePlan& feature) override;
  [[nodiscard]] core::Result<core::Pose> home_fixture() override;
  [[nodiscard]] core::Result<core::Pose> turn_to(const core::Pose& commanded) override;

  [[nodiscard]] core::Result<core::Pose> replay_home() override;
  [[nodiscard]] core::Result<core::Pose> replay_turn(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<void> replay_touch(const cmm::TouchCommand& command,
                                                const cmm::TouchReading& reading) override {
    return machine_.continue_after(command, reading);
  }
  [[nodiscard]] core::Result<void> replay_scan(const cmm::ScanCircleCommand& command,
                                               const cmm::TouchReading& last) override {
    return machine_.continue_after(command, last);
  }
  void replay_stand(const Eigen::Vector3d& tip_W_mm, double time_s) override {
    machine_.continue_at(cmm::on_grid_mm(tip_W_mm), time_s);
  }
  [[nodiscard]] core::Result<core::Pose> home_again() override;

  /// Sets the number of the next turn of the fixture, counted from its homing as number 0; the turn
  /// then has the noise of that number.
  void continue_at_turn(std::uint64_t number) { fixture_.continue_after(number - 1); }

  [[nodiscard]] std::optional<Eigen::Isometry3d> true_body_to_machine() const override {
    return true_X_WF_ * fixture_.true_body_to_machine();
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> true_tips_W_mm() const override {
    return machine_.true_tips_W_mm();
  }
  [[nodiscard]] std::optional<fixture::AxisErrors> true_errors(bool carried,
                                                               double angle_rad) const override {
    return fixture_.true_errors(carried, angle_rad);
  }

 private:
  void place_part();
  /// Seat, holes, dowels and bolt heads of the base.
  void add_holes(const DatumPlan& datum, double tip_mm);
  core::Result<core::Pose> turn(const core::Pose& commanded);
  core::Result<core::Pose> turn_driven(const core::Pose& commanded);
  core::Result<core::Pose> home_driven();

  SimulationPlan simulation_;
  std::unique_ptr<fixture::Fixture> driven_;
  fixture::SimulatedFixture fixture_;  ///< Turns the part in software.
  cmm::SimulatedMachine machine_;
  std::vector<FeaturePlan> features_;
  bool whole_part_ = false;                     ///< All surfaces at once: see has_whole_part().
  std::optional<cmm::SimulatedPart> part_;      ///< None for balls on the ring.
  std::vector<cmm::ReferenceBody> references_;  ///< On table and base, machine frame.
  std::vector<cmm::ReferenceBody> balls_;       ///< Carried by the ring, part frame.
  /// Spheres that show the pose of the ring, body frame.
  std::vector<cmm::ReferenceBody> ring_spheres_;
  Eigen::Isometry3d true_X_WF_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d true_X_BP_ = Eigen::Isometry3d::Identity();
  /// Shift of the part during the interruption.
  Eigen::Vector3d shift_mm_ = Eigen::Vector3d::Zero();
  std::uint64_t turns_ = 0;  ///< Turns of the fixture since its homing.
  core::Pose last_turn_;     ///< Pose commanded last.
};

}  // namespace rondure::plans
