#include "plans/cell/simulated_cell.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "fixture/fixture.h"
#include "fixture/simulated.h"
#include "plans/cell/internal/fixture_driver.h"
#include "plans/cell/internal/hidden_errors.h"
#include "plans/path/internal/nominal_geometry.h"

namespace rondure::plans {
namespace {

constexpr double kAnyTurn_rad = core::kTwoPi;

fixture::SimulatedFixtureOptions fixture_options(const Plan& plan, std::uint64_t seed,
                                                 bool resumed) {
  const FixturePlan& fixture = *plan.fixture;
  const SimulatedFixturePlan& hidden = plan.simulation->fixture;
  fixture::SimulatedFixtureOptions out;
  out.kinematics = nominal_kinematics(fixture);
  out.limits = limits_of(fixture);
  out.errors.axis_point_mm = vector3(hidden.axis_point_error_um) * core::kMicrometre;
  out.errors.axis_offset_mm = vector3(hidden.axis_offset_error_um) * core::kMicrometre;
  out.errors.zero_alpha_rad = hidden.zero_alpha_deg * core::kDegree;
  out.errors.zero_beta_rad = hidden.zero_beta_deg * core::kDegree;
  out.errors.squareness_rad = hidden.squareness_deg * core::kDegree;
  out.errors.repeatability_rad = hidden.repeatability_deg * core::kDegree;
  if (hidden.motion) {
    const fixture::MotionClass size = {hidden.motion->offset_um * core::kMicrometre,
                                       hidden.motion->tilt_urad * fixture::kMicroradian,
                                       hidden.motion->shift_um * core::kMicrometre,
                                       hidden.motion->turn_urad * fixture::kMicroradian,
                                       hidden.motion->seed};
    out.errors.alpha_motion = fixture::drawn_motion(size, Eigen::Vector3d::UnitX(), 0);
    out.errors.beta_motion = fixture::drawn_motion(size, Eigen::Vector3d::UnitY(), 1);
  }
  out.seed = seed;
  const int stall = plan.simulation->faults.fixture_stalls_at_move;
  if (!resumed) out.stalls_at_move = static_cast<std::uint64_t>(stall);
  if (drives_fixture(plan)) {  // follows a real one with its own limits and resolution
    out.limits = {-kAnyTurn_rad, kAnyTurn_rad, -kAnyTurn_rad, kAnyTurn_rad, 0.0};
  }
  return out;
}

cmm::SimulatedMachineOptions machine_options(const Plan& plan, std::uint64_t seed, bool resumed) {
  cmm::SimulatedMachineOptions out;
  if (!plan.machine->tool.empty()) out.tool = plan.machine->tool;
  out.nominal_tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  out.park_W_mm = vector3(plan.machine->park_mm);
  out.speeds.travel_mm_s = plan.machine->travel_speed_mm_s;
  out.speeds.touch_mm_s = plan.machine->touch_speed_mm_s;
  out.speeds.scan_mm_s = plan.machine->scan_speed_mm_s;
  out.temperature_degC = plan.simulation->temperature_degC;
  out.errors = machine_errors(*plan.simulation);
  out.part_errors = part_errors(plan.simulation->part);
  out.scan_scatter = scan_scatter(plan.simulation->machine);
  out.seed = seed;
  if (!resumed) out.lost_at_touch = plan.simulation->faults.connection_lost_at_touch;
  return out;
}

/// True seat of the simulated part: shifted and tilted about the part origin.
Eigen::Isometry3d true_seat(const Eigen::Isometry3d& nominal, const SimulatedPartPlan& part) {
  const double toward = part.tilt_toward_deg * core::kDegree;
  Eigen::Isometry3d seat = nominal;
  seat.translate(Eigen::Vector3d(part.offset_x_mm, part.offset_y_mm, 0.0));
  seat.rotate(Eigen::AngleAxisd(part.tilt_deg * core::kDegree,
                                Eigen::Vector3d(-std::sin(toward), std::cos(toward), 0.0)));
  return seat;
}

/// The same, moved up to the middle of a surface, which is the origin of its own frame.
Eigen::Isometry3d true_seat(const Eigen::Isometry3d& nominal, const SimulatedPartPlan& part,
                            const FeaturePlan& feature) {
  Eigen::Isometry3d seat = true_seat(nominal, part);
  seat.translate(
      Eigen::Vector3d(0.0, 0.0, 0.5 * (feature.nominal.from_mm + feature.nominal.to_mm)));
  return seat;
}

/// True position of the simulated fixture on the table.
Eigen::Isometry3d true_base(const SimulatedFixturePlan& hidden) {
  const Eigen::Vector3d turn = vector3(hidden.base_rotation_deg) * core::kDegree;
  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
  X_WF.translate(vector3(hidden.base_offset_mm));
  X_WF.rotate(Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()));
  X_WF.rotate(Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()));
  X_WF.rotate(Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()));
  return X_WF;
}

/// The sphere or the column that qualifies the probe.
cmm::ReferenceBody reference_artefact(const Plan& plan) {
  const QualificationPlan& q = plan.probe->qualification;
  cmm::ReferenceBody out{vector3(q.place_mm()), 0.5 * q.diameter_mm()};
  if (!q.on_column()) return out;
  const double lean_rad = plan.simulation->probe.column_lean_deg * core::kDegree;
  const Eigen::Vector3d axis(std::tan(lean_rad), 0.0, 1.0);
  out.shape = cmm::ReferenceBody::Shape::kColumn;
  out.axis = axis.normalized();
  out.half_length_mm = 0.5 * (q.column_to_mm - q.column_from_mm);
  out.center_W_mm += 0.5 * (q.column_from_mm + q.column_to_mm) * axis;
  return out;
}

}  // namespace

SimulatedCell::SimulatedCell(const Plan& plan, std::uint64_t seed, bool resumed,
                             std::unique_ptr<fixture::Fixture> driven)
    : Cell(plan),
      simulation_(*plan.simulation),
      driven_(std::move(driven)),
      fixture_(fixture_options(plan, seed, resumed)),
      machine_(machine_options(plan, seed, resumed)),
      features_(plan.features),
      whole_part_(has_whole_part(plan)),
      true_X_WF_(true_base(plan.simulation->fixture)) {
  if (const auto& datum = plan.fixture->datum) {
    for (const DatumSpherePlan& sphere : datum->spheres) {
      references_.push_back(
          {true_X_WF_ * vector3(sphere.center_mm), 0.5 * datum->sphere_diameter_mm});
    }
    add_holes(*datum, 0.5 * plan.probe->tip_diameter_mm);
  }
  references_.push_back(reference_artefact(plan));
  machine_.place_references(references_);
  if (const auto& reached = plan.fixture->reached_pose) {
    for (const CarriedSpherePlan& sphere : reached->spheres) {
      ring_spheres_.push_back({vector3(sphere.center_mm), 0.5 * reached->sphere_diameter_mm});
    }
  }
}

void SimulatedCell::add_holes(const DatumPlan& datum, double tip_mm) {
  using Shape = cmm::ReferenceBody::Shape;
  constexpr double kSpot_mm = 10.0;
  const Eigen::Vector3d up = true_X_WF_.linear().col(2);
  for (const DatumSeatPlan& at : datum.seat) {
    references_.push_back({true_X_WF_ * vector3(at.point_mm), kSpot_mm, Shape::kSpot, 0.0, up});
  }
  for (const DatumHolePlan& hole : datum.holes) {
    const bool inside = hole.side == record::Side::kInside;
    // A hole goes on below its lowest touch.
    const double half_mm =
        0.5 * (hole.depth_mm + (inside ? 2.0 * tip_mm + datum.uncertainty_mm : 0.0));
    // The block around it does not fill its neighbours.
    double wall_mm = cmm::kBlockWall_mm;
    for (const DatumHolePlan& other : datum.holes) {
      if (&other != &hole) wall_mm = std::min(wall_mm, between_mm(hole, other));
    }
    references_.push_back(
        {true_X_WF_ * vector3(hole.center_mm) + (inside ? -half_mm : half_mm) * up,
         0.5 * hole.diameter_mm, inside ? Shape::kHole : Shape::kColumn, half_mm, up, wall_mm});
  }
}

void SimulatedCell::mount(const FeaturePlan& feature) {
  balls_.clear();
  if (feature.rotary_axes) {
    part_.reset();
    machine_.remove_part();
    // The artefact has the same seat error in the ring as the simulated part.
    true_X_BP_ = true_seat(Eigen::Isometry3d::Identity(), simulation_.part, feature);
    for (const record::BallTask& ball : feature.rotary_axes->balls) {
      balls_.push_back({vector3(ball.center_mm), 0.5 * feature.rotary_axes->ball_diameter_mm});
    }
    return place_part();
  }
  if (whole_part_) {
    part_ = simulated_part(features_, simulation_, feature);
    true_X_BP_ = true_seat(nominal_part(), simulation_.part);
  } else {
    part_ = cmm::SimulatedPart{{{simulated_surface(simulation_, feature)}}};
    true_X_BP_ = true_seat(nominal_part(), simulation_.part, feature);
  }
  place_part();
}

core::Result<core::Pose> SimulatedCell::home_fixture() {
  return driven_ ? home_driven() : replay_home();
}

core::Result<core::Pose> SimulatedCell::turn_to(const core::Pose& commanded) {
  return driven_ ? turn_driven(commanded) : turn(commanded);
}

core::Result<core::Pose> SimulatedCell::replay_home() {
  auto reached = fixture_.home();
  turns_ = 0;
  place_part();
  return reached;
}

/// Turns the real fixture and moves the part to the pose that it reads.
core::Result<core::Pose> SimulatedCell::turn_driven(const core::Pose& commanded) {
  const auto reached = driven_->move_to(on_grid(commanded));
  if (!reached) return reached;
  auto shown = turn(*reached);
  if (shown) last_turn_ = commanded;
  return shown;
}

core::Result<core::Pose> SimulatedCell::home_driven() {
  const auto reached = driven_->home();
  if (!reached) return reached;
  if (auto shown = replay_home(); !shown) return shown;
  return on_grid(*reached);
}

core::Result<core::Pose> SimulatedCell::replay_turn(const core::Pose& commanded) {
  if (driven_) {
    TRY_DO(fixture::check_pose_range(driven_->limits(), commanded));
  }
  return turn(commanded);
}

core::Result<core::Pose> SimulatedCell::turn(const core::Pose& commanded) {
  const auto reached = fixture_.move_to(on_grid(commanded));
  if (reached) {
    ++turns_;
    last_turn_ = commanded;
  }
  place_part();
  if (!reached) return reached;
  return on_grid(*reached);
}

core::Result<core::Pose> SimulatedCell::home_again() {
  shift_mm_.x() = simulation_.faults.part_moved_um * core::kMicrometre;
  fixture_.stop_beside(simulation_.faults.fixture_off_deg * core::kDegree);
  TRY_DO(machine_.home());
  if (driven_) {
    const core::Pose last = last_turn_;
    const std::uint64_t turns = turns_;
    auto home = home_driven();
    if (!home || turns == 0) return home;
    fixture_.continue_after(turns - 1);
    auto back = turn_driven(last);
    turns_ = turns;
    return back;
  }
  auto reached = fixture_.home();
  if (reached && turns_ > 0) {
    fixture_.continue_after(turns_ - 1);
    reached = fixture_.move_to(on_grid(last_turn_));
  }
  place_part();
  if (!reached) return reached;
  return on_grid(*reached);
}

void SimulatedCell::place_part() {
  const Eigen::Isometry3d X_WB = true_X_WF_ * fixture_.true_body_to_machine();
  const Eigen::Isometry3d X_WP = X_WB * Eigen::Translation3d(shift_mm_) * true_X_BP_;
  if (part_) machine_.place_part(*part_, X_WP);
  std::vector<cmm::ReferenceBody> bodies = references_;
  for (const cmm::ReferenceBody& ball : balls_) {
    bodies.push_back({X_WP * ball.center_W_mm, ball.radius_mm});
  }
  for (const cmm::ReferenceBody& sphere : ring_spheres_) {
    bodies.push_back({X_WB * sphere.center_W_mm, sphere.radius_mm});
  }
  machine_.place_references(std::move(bodies));
}

}  // namespace rondure::plans
