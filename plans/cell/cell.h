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

/// Fixture, machine and part together, on which a plan is executed. The runner uses nothing else;
/// open_cell() selects the drivers.
class Cell {
 public:
  virtual ~Cell() = default;
  Cell(const Cell&) = delete;
  Cell& operator=(const Cell&) = delete;

  [[nodiscard]] virtual fixture::Fixture& fixture() = 0;
  [[nodiscard]] virtual cmm::Machine& machine() = 0;
  /// Whether the part exists in software only, in this program or in a simulated server.
  [[nodiscard]] virtual bool is_simulated() const = 0;
  /// Nominal axes on the located base, with the calibrated errors: all the knowledge the program
  /// may use.
  [[nodiscard]] const fixture::Kinematics& kinematics() const { return kinematics_; }
  /// Sets the located base of the fixture.
  void set_base(const Eigen::Isometry3d& X_WF) { kinematics_.X_WF = X_WF; }
  /// From now on the kinematics include the errors of this calibration.
  void use(const fixture::Calibration& calibration) {
    kinematics_ = fixture::compensated(kinematics_, calibration);
  }
  /// Nominal part frame in the body frame: X_BP.
  [[nodiscard]] const Eigen::Isometry3d& nominal_part() const { return X_BP_; }

  /// Where the tip stands in the part system of the control; kMachine where there is none. The
  /// control of a simulated machine has a part without a fixture aligned, as it truly stands.
  [[nodiscard]] virtual core::Result<Eigen::Vector3d> tip_in_part_system_mm() = 0;

  /// Selects the feature of the clamped part that is measured from now on.
  virtual void mount(const FeaturePlan& feature) = 0;
  /// Turns the fixture; the part follows.
  [[nodiscard]] virtual core::Result<core::Pose> home_fixture() = 0;
  [[nodiscard]] virtual core::Result<core::Pose> turn_to(const core::Pose& commanded) = 0;

  // A resumed run replays its journal without moving anything. A cell whose state depends on the
  // past updates it here: a simulation then has the pose, the clock and the hidden truth of the
  // interrupted run.

  /// Replays the homing of the fixture.
  [[nodiscard]] virtual core::Result<core::Pose> replay_home() = 0;
  /// Replays a turn of the fixture; kPoseRange for one that was refused.
  [[nodiscard]] virtual core::Result<core::Pose> replay_turn(const core::Pose& commanded) = 0;
  /// Replays a touch; kNoTouch or kCollision when the part cannot have given it. Also called once
  /// after the checks, so that the clock continues as if there had been no interruption.
  [[nodiscard]] virtual core::Result<void> replay_touch(const cmm::TouchCommand& command,
                                                        const cmm::TouchReading& reading) = 0;
  /// Replays a scan, by its last reading; otherwise like replay_touch().
  [[nodiscard]] virtual core::Result<void> replay_scan(const cmm::ScanCircleCommand&,
                                                       const cmm::TouchReading& /*last*/) {
    return {};
  }
  /// Sets the tip of a simulation to a place and its clock to a time of the interrupted run.
  virtual void replay_stand(const Eigen::Vector3d& /*tip_W_mm*/, double /*time_s*/) {}
  /// Homes machine and fixture and turns the part to the pose of the last replayed turn. Returns
  /// the pose that the fixture reads there.
  [[nodiscard]] virtual core::Result<core::Pose> home_again() = 0;

  /// Tip centres of the last touch, or of all points of the last scan, without errors; empty unless
  /// this program simulates the cell. For the truth that a simulation shows beside its result.
  [[nodiscard]] virtual std::vector<Eigen::Vector3d> true_tips_W_mm() const { return {}; }
  /// The true errors of an axis of the fixture, if this program simulates it; see
  /// SimulatedFixture::true_errors().
  [[nodiscard]] virtual std::optional<fixture::AxisErrors> true_errors(bool /*carried*/,
                                                                       double /*angle_rad*/) const {
    return std::nullopt;
  }
  /// True position of the body frame, if this program simulates the cell.
  [[nodiscard]] virtual std::optional<Eigen::Isometry3d> true_body_to_machine() const {
    return std::nullopt;
  }

 protected:
  /// @param plan  Must have `fixture`.
  explicit Cell(const Plan& plan);

 private:
  fixture::Kinematics kinematics_;
  Eigen::Isometry3d X_BP_ = Eigen::Isometry3d::Identity();
};

/// Settings of a cell that are not part of its plan.
struct CellOptions {
  std::uint64_t seed = 1;  ///< Seed of all simulated noise; replaces the seed of the plan.
  bool resumed = false;    ///< The simulated faults have already occurred.
  std::filesystem::path wire_log = {};        ///< Log of all lines from and to a machine; "": none.
  std::function<bool()> stop_requested = {};  ///< Polled during motions; true stops at once.
  fixture::SetByHand set_by_hand = {};        ///< For a fixture "manual" with a real machine.
};

}  // namespace rondure::plans
