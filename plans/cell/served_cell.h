#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cmm/ipp/grammar.h"
#include "cmm/ipp_server/backend.h"
#include "cmm/ipp_server/server.h"
#include "plans/cell/simulated_cell.h"
#include "plans/plan.h"

namespace rondure::plans {

/// The simulated cell of a plan for an I++ DME server: machine, part or balls, and the two-axis
/// fixture, which AlignPart turns; without a fixture a machine that has no rotary table.
class ServedCell final : public cmm::ipp::Backend {
 public:
  /// @param plan  Must have `machine`, `fixture`, `probe` and `simulation`, and a feature to touch;
  ///              the first of these is mounted.
  ServedCell(const Plan& plan, std::uint64_t seed);

  [[nodiscard]] cmm::Machine& machine() override { return cell_.machine(); }
  [[nodiscard]] std::vector<double> table_angles_deg() const override;
  [[nodiscard]] core::Result<void> home_table() override;
  [[nodiscard]] core::Result<std::vector<Eigen::Vector3d>> align_part(
      std::span<const cmm::ipp::Alignment> alignments) override;
  [[nodiscard]] Eigen::Isometry3d part_system() const override {
    return turns_ ? Eigen::Isometry3d::Identity() : cell_.part_system();
  }
  [[nodiscard]] core::Result<void> choose_feature(int index) override;
  void set_next_turn(std::uint64_t number) override { cell_.continue_at_turn(number); }

 private:
  std::vector<FeaturePlan> features_;
  SimulatedCell cell_;
  bool turns_;       ///< There is a fixture.
  core::Pose pose_;  ///< Pose as read back from the fixture.
};

/// The point meant by I++ DME commands, from `machine.point`.
[[nodiscard]] cmm::ipp::NamedPoint named_point_of(const MachinePlan& machine);
/// The form of sent numbers, from `machine.numbers`.
[[nodiscard]] cmm::ipp::NumberForm number_form_of(const MachinePlan& machine);

/// The settings of the server from the plan: speeds, distances, tip, temperature, named points,
/// numbers.
[[nodiscard]] cmm::ipp::ServerOptions server_options(const Plan& plan);

/// kMeaning, with the remedy, when the plan cannot be served: no simulation, or no feature to
/// touch.
[[nodiscard]] core::Result<void> check_servable(const Plan& plan);

}  // namespace rondure::plans
