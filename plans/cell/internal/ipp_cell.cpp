#include "plans/cell/internal/ipp_cell.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/units.h"
#include "fixture/kinematics.h"
#include "plans/analyses/features.h"
#include "plans/cell/served_cell.h"
#include "plans/path/internal/nominal_geometry.h"
#include "wire/tcp_line.h"
#include "wire/wire_log.h"

namespace rondure::plans {
namespace {

std::chrono::milliseconds milliseconds_of(double time_s) {
  return std::chrono::milliseconds(std::llround(1000.0 * time_s));
}

/// The directions of z and y of the ring in a pose. The axes of the fixture are those of the
/// machine, so only the rotation matters.
cmm::IppMachine::Alignment alignment_of(const core::Pose& pose) {
  const Eigen::Matrix3d R = fixture::body_to_machine({}, pose).linear();
  return {R.col(2), R.col(1)};
}

/// The pose with these directions of z and y of the ring: with R = Rx(alpha) Ry(beta), y is (0, cos
/// alpha, sin alpha), and z turned back by alpha (sin beta, 0, cos beta).
core::Pose pose_of(const cmm::IppMachine::Alignment& reached) {
  const Eigen::Vector3d& z = reached.first_W;
  const Eigen::Vector3d& y = reached.second_W;
  const double alpha_rad = std::atan2(y.z(), y.y());
  const double up = std::cos(alpha_rad) * z.z() - std::sin(alpha_rad) * z.y();
  return {alpha_rad, std::atan2(z.x(), up)};
}

cmm::IppMachineOptions machine_options(const Plan& plan, const CellOptions& options) {
  const MachinePlan& machine = *plan.machine;
  cmm::IppMachineOptions out;
  out.tool = machine.tool;
  out.park_W_mm = vector3(machine.park_mm);
  out.speeds.travel_mm_s = machine.travel_speed_mm_s;
  out.speeds.touch_mm_s = machine.touch_speed_mm_s;
  out.speeds.scan_mm_s = machine.scan_speed_mm_s;
  out.answer_limit = milliseconds_of(machine.answer_limit_s);
  out.motion_limit = milliseconds_of(machine.motion_limit_s);
  out.abort_works = machine.abort == MachinePlan::Abort::kWorks;
  out.returns_to_approach = machine.retract == MachinePlan::Retract::kToApproach;
  out.point = named_point_of(machine);
  out.numbers = number_form_of(machine);
  out.tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  out.tip_tolerance_mm = plan.probe->qualification.radius_tolerance_um * core::kMicrometre;
  out.stop_requested = options.stop_requested;
  return out;
}

/// Connects, with a log if the run has one.
cmm::IppMachine::Connect connector(const MachinePlan& machine,
                                   const std::filesystem::path& wire_log) {
  wire::TcpOptions tcp;
  tcp.connect_limit = milliseconds_of(machine.answer_limit_s);
  tcp.write_limit = tcp.connect_limit;
  const auto port = static_cast<std::uint16_t>(machine.port);
  return [host = machine.host, port, tcp,
          wire_log]() -> core::Result<std::unique_ptr<wire::LineTransport>> {
    auto line = wire::connect_tcp(host, port, tcp);
    if (!line || wire_log.empty()) return line;
    return wire::logged(std::move(*line), wire_log, wire::Side::kClient);
  };
}

}  // namespace

std::string IppFixture::description() const {
  return fmt::format("rotary axes of the machine (I++ DME AlignPart), resolution {:.7g} deg",
                     limits_.resolution_rad / core::kDegree);
}

core::Result<core::Pose> IppFixture::move_to(const core::Pose& commanded) {
  TRY_DO(fixture::check_pose_range(limits_, commanded));
  TRY(const auto reached, machine_.align_part(alignment_of(on_grid(commanded))));
  return on_grid(pose_of(reached));
}

IppCell::IppCell(const Plan& plan, std::unique_ptr<cmm::IppMachine> machine,
                 std::unique_ptr<fixture::Fixture> driven)
    : Cell(plan), machine_(std::move(machine)), fixture_(std::move(driven)) {
  if (!fixture_) fixture_ = std::make_unique<IppFixture>(*machine_, limits_of(*plan.fixture));
  for (const FeaturePlan& feature : plan.features) features_.push_back(feature.id);
}

core::Result<std::unique_ptr<Cell>> IppCell::open(const Plan& plan, const CellOptions& options,
                                                  std::unique_ptr<fixture::Fixture> driven) {
  TRY(auto machine, cmm::IppMachine::open(connector(*plan.machine, options.wire_log),
                                          machine_options(plan, options)));
  if (driven && !is_fixed(plan) && machine->is_simulated()) {
    return core::fail(core::Code::kMachine,
                      "the machine is a simulation: a fixture that stands here does not turn its "
                      "part; give the fixture the driver \"ippdme\"",
                      "/fixture/driver");
  }
  if (!driven && !machine->has_rotary_table()) {
    return core::fail(
        core::Code::kMachine,
        fmt::format("the machine calls itself {}: it has no rotary axes that could turn the part; "
                    "the fixture of the plan is \"ippdme\"",
                    machine->identity().machine_class),
        "/fixture/driver");
  }
  return std::unique_ptr<Cell>(new IppCell(plan, std::move(machine), std::move(driven)));
}

void IppCell::mount(const FeaturePlan& feature) {
  const auto found = std::find(features_.begin(), features_.end(), feature.id);
  feature_ = found - features_.begin();
}

core::Result<void> IppCell::send_feature() {
  if (feature_ == sent_feature_) return {};
  sent_feature_ = feature_;
  return machine_->tell_simulation("Simulation.Feature", feature_);
}

void IppCell::note_turn(const core::Pose& commanded) {
  ++turns_;
  last_turn_ = commanded;
}

core::Result<core::Pose> IppCell::home_fixture() {
  TRY_DO(send_feature());
  auto reached = fixture_->home();
  if (!reached) return reached;
  turns_ = 0;
  TRY_DO(machine_->tell_simulation("Simulation.NextTurn", 1));
  return reached;
}

core::Result<core::Pose> IppCell::turn_to(const core::Pose& commanded) {
  TRY_DO(send_feature());
  auto reached = fixture_->move_to(on_grid(commanded));
  if (!reached) return reached;
  note_turn(commanded);
  return on_grid(*reached);
}

core::Result<core::Pose> IppCell::replay_home() {
  turns_ = 0;
  return core::Pose{};
}

core::Result<core::Pose> IppCell::replay_turn(const core::Pose& commanded) {
  TRY_DO(fixture::check_pose_range(fixture_->limits(), commanded));
  note_turn(commanded);
  return commanded;
}

core::Result<core::Pose> IppCell::home_again() {
  TRY_DO(machine_->home());
  TRY_DO(send_feature());
  auto reached = fixture_->home();
  if (!reached) return reached;
  const std::int64_t next_turn = std::max<std::int64_t>(1, turns_);
  TRY_DO(machine_->tell_simulation("Simulation.NextTurn", next_turn));
  return turns_ == 0 ? reached : fixture_->move_to(on_grid(last_turn_));
}

}  // namespace rondure::plans
