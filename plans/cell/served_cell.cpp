#include "plans/cell/served_cell.h"

#include <algorithm>

#include "core/units.h"
#include "fixture/alignment.h"
#include "fixture/kinematics.h"
#include "plans/analyses/features.h"

namespace rondure::plans {

ServedCell::ServedCell(const Plan& plan, std::uint64_t seed)
    : features_(plan.features), cell_(plan, seed, false), turns_(!is_fixed(plan)) {
  const auto first = std::find_if(features_.begin(), features_.end(), needs_machine);
  if (first != features_.end()) cell_.mount(*first);
}

std::vector<double> ServedCell::table_angles_deg() const {
  if (!turns_) return {};
  return {pose_.alpha_rad / core::kDegree, pose_.beta_rad / core::kDegree};
}

core::Result<void> ServedCell::home_table() {
  TRY(pose_, cell_.home_fixture());
  return {};
}

core::Result<std::vector<Eigen::Vector3d>> ServedCell::align_part(
    std::span<const cmm::ipp::Alignment> alignments) {
  std::vector<fixture::DirectionPair> pairs;
  for (const auto& [part, machine] : alignments) pairs.push_back({part, machine});
  TRY(pose_, cell_.turn_to(fixture::aligning_pose(pairs, pose_)));
  const Eigen::Matrix3d turned = fixture::body_to_machine(cell_.kinematics(), pose_).linear();
  std::vector<Eigen::Vector3d> out;
  for (const auto& [part, machine] : alignments) out.emplace_back(turned * part);
  return out;
}

core::Result<void> ServedCell::choose_feature(int index) {
  const auto count = static_cast<int>(features_.size());
  if (index < 0 || index >= count || !needs_machine(features_[static_cast<std::size_t>(index)])) {
    return core::fail_with(core::Code::kOutOfRange,
                           "feature {} is none of the {} that can be touched", index, count);
  }
  cell_.mount(features_[static_cast<std::size_t>(index)]);
  return {};
}

cmm::ipp::NamedPoint named_point_of(const MachinePlan& machine) {
  return machine.point == MachinePlan::Point::kCenter ? cmm::ipp::NamedPoint::kCenter
                                                      : cmm::ipp::NamedPoint::kSurface;
}

cmm::ipp::NumberForm number_form_of(const MachinePlan& machine) {
  return machine.numbers == MachinePlan::Numbers::kSixteenCharacters
             ? cmm::ipp::NumberForm::kSixteenCharacters
             : cmm::ipp::NumberForm::kSixteenDigits;
}

cmm::ipp::ServerOptions server_options(const Plan& plan) {
  cmm::ipp::ServerOptions out;
  cmm::ipp::ControllerOptions& controller = out.controller;
  controller.defaults.speeds.travel_mm_s = plan.machine->travel_speed_mm_s;
  controller.defaults.speeds.touch_mm_s = plan.machine->touch_speed_mm_s;
  controller.defaults.speeds.scan_mm_s = plan.machine->scan_speed_mm_s;
  controller.defaults.approach_mm = plan.machine->approach_mm;
  controller.defaults.search_mm = plan.machine->search_mm;
  controller.point = named_point_of(*plan.machine);
  controller.numbers = number_form_of(*plan.machine);
  controller.tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  controller.temperature_degC = plan.simulation->temperature_degC;
  return out;
}

core::Result<void> check_servable(const Plan& plan) {
  if (touches_anything(plan) && plan.machine && plan.fixture && plan.probe && plan.simulation)
    return {};
  return core::fail(core::Code::kMeaning,
                    "the plan has no virtual machine to serve: it needs machine, fixture, probe, "
                    "simulation and a feature that is touched");
}

}  // namespace rondure::plans
