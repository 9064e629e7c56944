#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cmm/ipp_client/client.h"
#include "fixture/fixture.h"
#include "plans/cell/cell.h"

namespace rondure::plans {

/// Two rotary axes of an I++ DME machine as a fixture. AlignPart (14 numbers) turns z and y of the
/// ring to their directions in the commanded pose; the pose reached follows from their directions
/// afterwards.
class IppFixture final : public fixture::Fixture {
 public:
  /// @param machine  Outlives the fixture.
  IppFixture(cmm::IppMachine& machine, const fixture::FixtureLimits& limits)
      : machine_(machine), limits_(limits) {}

  [[nodiscard]] std::string description() const override;
  [[nodiscard]] const fixture::FixtureLimits& limits() const override { return limits_; }
  [[nodiscard]] core::Result<core::Pose> home() override { return move_to({}); }
  [[nodiscard]] core::Result<core::Pose> move_to(const core::Pose& commanded) override;

 private:
  cmm::IppMachine& machine_;
  fixture::FixtureLimits limits_;
};

/// Machine and fixture over I++ DME, with a real part or with the simulated cell of rondure
/// simulate-cmm. A real part has no state that depends on the past. The simulator receives the
/// feature to measure and the number of the next turn of the fixture, so that a resumed run has the
/// noise of the uninterrupted one. The fixture is the rotary axes of the machine, or a real one
/// that this program drives.
class IppCell final : public Cell {
 public:
  /// Connects. Nothing moves. kMachine when there is no answer, when the machine has no rotary
  /// axes, or when it is a simulation whose part a real fixture cannot turn.
  /// @param driven  A real fixture; nullptr: the rotary axes of the machine.
  [[nodiscard]] static core::Result<std::unique_ptr<Cell>> open(
      const Plan& plan, const CellOptions& options,
      std::unique_ptr<fixture::Fixture> driven = nullptr);

  [[nodiscard]] fixture::Fixture& fixture() override { return *fixture_; }
  [[nodiscard]] cmm::Machine& machine() override { return *machine_; }
  [[nodiscard]] bool is_simulated() const override { return machine_->is_simulated(); }

  [[nodiscard]] core::Result<Eigen::Vector3d> tip_in_part_system_mm() override {
    return machine_->tip_in_part_system_mm();
  }

  void mount(const FeaturePlan& feature) override;
  [[nodiscard]] core::Result<core::Pose> home_fixture() override;
  [[nodiscard]] core::Result<core::Pose> turn_to(const core::Pose& commanded) override;

  [[nodiscard]] core::Result<core::Pose> replay_home() override;
  [[nodiscard]] core::Result<core::Pose> replay_turn(const core::Pose& commanded) override;
  [[nodiscard]] core::Result<void> replay_touch(const cmm::TouchCommand&,
                                                const cmm::TouchReading&) override {
    return {};
  }
  [[nodiscard]] core::Result<core::Pose> home_again() override;

 private:
  IppCell(const Plan& plan, std::unique_ptr<cmm::IppMachine> machine,
          std::unique_ptr<fixture::Fixture> driven);
  /// Sends the feature to a simulator if it has changed.
  [[nodiscard]] core::Result<void> send_feature();
  void note_turn(const core::Pose& commanded);

  std::unique_ptr<cmm::IppMachine> machine_;
  std::unique_ptr<fixture::Fixture> fixture_;
  std::vector<std::string> features_;  ///< Ids of the features, in the order of the plan.
  std::int64_t feature_ = 0;           ///< Index of the measured feature.
  std::int64_t sent_feature_ = -1;     ///< Last index sent to the simulator.
  std::int64_t turns_ = 0;             ///< Turns of the fixture since its homing.
  core::Pose last_turn_;               ///< Pose commanded last.
};

}  // namespace rondure::plans
