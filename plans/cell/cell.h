#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "cmm/machine.h"
#include "core/pose.h"
#include "core/result.h"
#include "fixture/calibration.h"
#include "fixture/fixture.h"
#include "fixture/kinematics.h"
#include "fixture/manual.h"
#include "plans/plan.h"

namespace rondure::plans {

/// Fixture, machine and part as one: what a plan is executed on. The runner sees nothing else of
/// the world; which drivers stand behind it is the matter of open_cell().
class Cell {
 public:
  virtual ~Cell() = default;
  Cell(const Cell&) = delete;
  Cell& operator=(const Cell&) = delete;

  [[nodiscard]] virtual fixture::Fixture& fixture() = 0;
  [[nodiscard]] virtual cmm::Machine& machine() = 0;
  /// Whether the part exists in software only, here or behind a simulated server.
  [[nodiscard]] virtual bool is_simulated() const = 0;
  /// Nominal axes, on the base as found, with the errors that are known: all that the program may
  /// assume.
  [[nodiscard]] const fixture::Kinematics& kinematics() const { return kinematics_; }
  /// The base of the fixture was found there.
  void set_base(const Eigen::Isometry3d& X_WF) { kinematics_.X_WF = X_WF; }
  /// From now on the errors of this calibration are reckoned with.
  void use(const fixture::Calibration& calibration) {
    kinematics_ = fixture::compensated(kinematics_, calibration);
  }
  /// Nominal part frame in the body frame: X_BP.
  [[nodiscard]] const Eigen::Isometry3d& nominal_part() const { return X_BP_; }

  /// From now on this feature of the part in the clamping ring is measured.
  virtual void mount(const FeaturePlan& feature) = 0;
  /// Turns the fixture; the part follows.
  [[nodiscard]] virtual core::Result<core::Pose> home_fixture() = 0;
  [[nodiscard]] virtual core::Result<core::Pose> turn_to(const core::Pose& commanded) = 0;

  // A resumed run goes through what its journal says once more, without moving anything. Whoever
  // keeps state that depends on the past keeps up with it here: a simulation has then the pose, the
  // clock and the hidden truth of the run that was interrupted.

  /// The homing of the fixture.
  [[nodiscard]] virtual core::Result<core::Pose> replay_home() = 0;
  /// A turn of the fixture; kPoseRange for one that was refused.
  [[nodiscard]] virtual core::Result<core::Pose> replay_turn(const core::Pose& commanded) = 0;
  /// A touch; kNoTouch or kCollision when the part cannot have given it. Also called once after the
  /// checks: the clock goes on as if there had been no interruption.
  [[nodiscard]] virtual core::Result<void> replay_touch(const cmm::TouchCommand& command,
                                                        const cmm::TouchReading& reading) = 0;
  /// A scan, by its last reading; otherwise like replay_touch().
  [[nodiscard]] virtual core::Result<void> replay_scan(const cmm::ScanCircleCommand& command,
                                                       const cmm::TouchReading& last);
  /// Homes machine and fixture and turns the part to where the last replayed turn left it; gives
  /// the pose that the fixture reads there.
  [[nodiscard]] virtual core::Result<core::Pose> home_again() = 0;

  /// Noise-free tip centre of the last touch, where the world is simulated in this program. For the
  /// truth that a simulation shows beside its result.
  [[nodiscard]] virtual std::optional<Eigen::Vector3d> true_tip_W_mm() const = 0;
  /// The same for all points of the last scan; empty where the world is real.
  [[nodiscard]] virtual std::vector<Eigen::Vector3d> true_scan_W_mm() const { return {}; }
  /// The true errors of an axis of the fixture, where it is simulated in this program; see
  /// SimulatedFixture::true_errors().
  [[nodiscard]] virtual std::optional<fixture::AxisErrors> true_errors(bool /*carried*/,
                                                                       double /*angle_rad*/) const {
    return std::nullopt;
  }
  /// Where the body frame really is, where the world is simulated in this program.
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> true_body_to_machine() const {
    return std::nullopt;
  }

 protected:
  /// @param plan  Has `fixture`.
  explicit Cell(const Plan& plan);

 private:
  fixture::Kinematics kinematics_;
  Eigen::Isometry3d X_BP_ = Eigen::Isometry3d::Identity();
};

/// What a cell needs to know beside its plan.
struct CellOptions {
  std::uint64_t seed = 1;               ///< Of all simulated noise; takes the place of the plan's.
  bool resumed = false;                 ///< The faults of the simulation lie in the past.
  std::filesystem::path wire_log = {};  ///< Of what goes to a machine and comes; "": none.
  std::function<bool()> stop_requested = {};  ///< Asked while a machine moves: it stops at once.
  fixture::SetByHand set_by_hand = {};        ///< Of a fixture "manual" in front of a real machine.
};

/// Whether a machine can do what the plan asks of it. kMachine, at the feature, when it is to scan
/// and cannot.
[[nodiscard]] core::Result<void> check_abilities(const Plan& plan,
                                                 const cmm::Capabilities& machine);

/// Opens the cell of a plan that has `machine`, `fixture` and `probe`, with the drivers it names.
/// Nothing moves. kMachine when a machine or a fixture cannot be reached, or lacks an ability
/// (check_abilities()).
[[nodiscard]] core::Result<std::unique_ptr<Cell>> open_cell(const Plan& plan,
                                                            const CellOptions& options);

}  // namespace rondure::plans
