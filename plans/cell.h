#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include "cmm/machine.h"
#include "cmm/simulated.h"
#include "core/pose.h"
#include "core/result.h"
#include "fixture/fixture.h"
#include "fixture/kinematics.h"
#include "fixture/simulated.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Fixture, machine and part as one: what a plan is executed on. The machine of a simulated cell
/// cannot know how the fixture moved the part; the cell tells it after every turn.
class Cell {
 public:
  /// Opens the simulated cell of a plan that has `machine`, `fixture`, `probe` and `simulation`.
  /// @param seed     Of all noise; takes the place of the plan's.
  /// @param resumed  The faults of the simulation lie in the past.
  Cell(const Plan& plan, std::uint64_t seed, bool resumed);

  [[nodiscard]] fixture::Fixture& fixture() { return fixture_; }
  [[nodiscard]] cmm::Machine& machine() { return machine_; }
  /// Nominal axes: all that the program may assume.
  [[nodiscard]] const fixture::Kinematics& kinematics() const { return kinematics_; }
  /// Nominal part frame in the body frame: X_BP.
  [[nodiscard]] const Eigen::Isometry3d& nominal_part() const { return X_BP_; }

  /// Puts the part with this feature into the clamping ring.
  void mount(const FeaturePlan& feature);
  /// Turns the fixture; the part follows.
  [[nodiscard]] core::Result<core::Pose> home_fixture();
  [[nodiscard]] core::Result<core::Pose> turn_to(const core::Pose& commanded);

  // A resumed run goes through what its journal says once more, without moving anything. The
  // simulation keeps up with it: pose, clock and hidden truth are those of the run that was
  // interrupted.

  /// The homing of the fixture.
  [[nodiscard]] core::Result<core::Pose> recall_home();
  /// A turn of the fixture; kPoseRange for one that was refused.
  [[nodiscard]] core::Result<core::Pose> recall_turn(const core::Pose& commanded);
  /// A touch; kNoTouch or kCollision when the simulated part cannot have given it. Also called
  /// once after the checks: the clock goes on as if there had been no interruption.
  [[nodiscard]] core::Result<void> recall_touch(const cmm::TouchCommand& command,
                                                const cmm::TouchReading& reading);
  /// Homes machine and fixture and turns the part to where the last recalled turn left it; gives
  /// the pose that the fixture reads there.
  [[nodiscard]] core::Result<core::Pose> home_again();

  /// Noise-free tip centre of the last touch. For the truth that a simulation shows beside its
  /// result.
  [[nodiscard]] Eigen::Vector3d true_tip_W_mm() const { return machine_.true_tip_W_mm(); }

 private:
  void place_part();
  core::Result<core::Pose> turn(const core::Pose& commanded);

  SimulationPlan simulation_;
  fixture::Kinematics kinematics_;
  Eigen::Isometry3d X_BP_ = Eigen::Isometry3d::Identity();
  fixture::SimulatedFixture fixture_;
  cmm::SimulatedMachine machine_;
  std::optional<cmm::PartSurface> surface_;
  Eigen::Isometry3d true_X_BP_ = Eigen::Isometry3d::Identity();
  Eigen::Vector3d shift_mm_ = Eigen::Vector3d::Zero();  ///< Of the part, while interrupted.
  std::uint64_t turns_ = 0;                             ///< Of the fixture since its homing.
  core::Pose last_turn_;                                ///< As commanded.
};

}  // namespace rondure::plans
