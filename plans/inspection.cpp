#include "plans/inspection.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/ls_cylinder.h"
#include "fit/min_zone_circle.h"
#include "fit/min_zone_cylinder.h"

namespace rondure::plans {

core::Result<void> RunContext::check_stop() const {
  if (!options.stop_requested || !options.stop_requested()) return {};
  return core::fail(
      core::Code::kStopped,
      fmt::format("stopped by the operator after {} touches; all of them are kept", next_touch));
}

void RunContext::show() const {
  if (options.progress) options.progress(progress);
}

core::Result<record::Touch> RunContext::touch(cmm::TouchCommand command, record::Touch row) {
  if (auto stop = check_stop(); !stop) return core::fail(stop.error());
  command.id = next_touch;
  const auto reading = cell->machine().touch(command);
  if (!reading) return core::fail(reading.error());
  row.id = next_touch;
  row.tip_mm = reading->tip_W_mm;
  row.approach = command.direction_W;
  row.temperature_degC = reading->temperature_degC;
  row.time_s = reading->time_s;
  if (auto kept = journal.add(row); !kept) return core::fail(kept.error());
  ++next_touch;
  progress.touches = static_cast<std::size_t>(next_touch);
  show();
  return row;
}

core::Result<void> follow(cmm::Machine& machine, const Polyline& path,
                          const Eigen::Isometry3d& X_WX) {
  for (const Eigen::Vector3d& corner : path) {
    if (auto moved = machine.move_to(X_WX * corner); !moved) return moved;
  }
  return {};
}

core::Result<void> rise(const Plan& plan, cmm::Machine& machine) {
  Eigen::Vector3d up = machine.position_W_mm();
  up.z() = std::max(up.z(), plan.machine->park_mm[2]);
  return machine.move_to(up);
}

FeatureSession::FeatureSession(RunContext& context, int feature_index, std::vector<Target> targets)
    : context_(context),
      index_(feature_index),
      feature_(context.plan.features[static_cast<std::size_t>(feature_index)]),
      targets_(std::move(targets)),
      X_BP_(context.cell->nominal_part()),
      geometry_(path_geometry(context.plan, feature_, context.plan.part.location_uncertainty_mm)) {
  context_.progress.feature = feature_.id;
}

const fixture::FixtureLimits& FeatureSession::limits() const {
  return context_.cell->fixture().limits();
}

Eigen::Isometry3d FeatureSession::part_at(const core::Pose& pose) const {
  return fixture::body_to_machine(context_.cell->kinematics(), pose) * X_BP_;
}

/// The same fault with the point it happened at, and what a person can do about it.
tl::unexpected<core::Error> FeatureSession::fault_at(const Target& target,
                                                     const core::Error& error) const {
  // A stop by the operator and a journal that cannot be written have no place on the part.
  if (error.code == core::Code::kStopped || error.code == core::Code::kJournal) {
    return core::fail(error);
  }
  std::string advice;
  if (error.code == core::Code::kNoTouch || error.code == core::Code::kCollision) {
    advice =
        "; check that the part of the plan is clamped where the plan says "
        "(location_uncertainty_mm)";
  }
  if (error.code == core::Code::kCollision)
    advice += ", and move the tip clear by hand before the next run";
  return core::fail(
      error.code, fmt::format("feature {}, layer {}, point {}: {}{}", feature_.id, target.layer + 1,
                              target.point + 1, error.what, advice));
}

bool FeatureSession::must_locate() const {
  return context_.plan.part.location_uncertainty_mm > 0.0;
}

core::Result<void> FeatureSession::turn(const core::Pose& commanded,
                                        const std::vector<Target>& targets) {
  const FixturePlan& fixture = *context_.plan.fixture;
  const Surroundings surroundings{fixture.rim_height_mm, fixture.clamp_from_mm,
                                  fixture.clamp_to_mm};
  if (auto reach = check_reachable(targets, geometry_, part_at(commanded), surroundings); !reach)
    return reach;
  const auto reached = context_.cell->turn_to(commanded);
  if (!reached) return core::fail(reached.error());
  reached_ = *reached;
  repeat_ = 0;
  pose_id_ = context_.next_pose++;
  context_.progress.pose_number = ++visits_;
  context_.progress.pose = reached_;
  const double now = context_.cell->machine().time_s();
  return context_.journal.add(record::PoseVisit{pose_id_, index_, commanded, reached_, false, now});
}

core::Result<fit::Axis> FeatureSession::locate(const core::Pose& commanded) {
  const auto targets = locating_targets(feature_, context_.plan.part.location_uncertainty_mm);
  if (!targets) return core::fail(targets.error());
  if (auto turned = turn(commanded, *targets); !turned) return core::fail(turned.error());
  const auto tips = touch_cloud(*targets, record::Touch::Purpose::kLocate);
  if (!tips) return core::fail(tips.error());
  const auto cylinder = fit::ls_cylinder(*tips, Eigen::Vector3d::UnitZ());
  if (!cylinder) return core::fail(cylinder.error());
  follow_axis(cylinder->axis);
  return cylinder->axis;
}

core::Result<Cloud> FeatureSession::measure(const core::Pose& commanded) {
  if (auto turned = turn(commanded, targets_); !turned) return core::fail(turned.error());
  truth_.clear();
  auto tips = touch_cloud(targets_, record::Touch::Purpose::kMeasure);
  if (!tips) return core::fail(tips.error());
  return Cloud{reached_, std::move(*tips)};
}

core::Result<void> FeatureSession::repeat(int times) {
  for (int i = 0; i < times; ++i) {
    ++repeat_;
    if (auto tips = touch_cloud(targets_, record::Touch::Purpose::kMeasure); !tips)
      return core::fail(tips.error());
  }
  return {};
}

core::Result<void> FeatureSession::keep_as_final() {
  if (auto marked = context_.journal.mark_final(pose_id_); !marked) return marked;
  double zone_mm = 0.0;
  if (feature_.type == "circle") {
    std::vector<Eigen::Vector2d> section;
    for (const Eigen::Vector3d& tip : truth_) section.emplace_back(tip.head<2>());
    const auto zone = fit::min_zone_circle(section);
    if (!zone) return core::fail(zone.error());
    zone_mm = zone->width_mm();
  } else {
    const auto zone = fit::min_zone_cylinder(truth_, Eigen::Vector3d::UnitZ());
    if (!zone) return core::fail(zone.error());
    zone_mm = zone->width_mm();
  }
  return context_.journal.add(record::SimulationTruth{index_, zone_mm});
}

void FeatureSession::follow_axis(const fit::Axis& axis_W) {
  const Eigen::Isometry3d X_BW =
      fixture::body_to_machine(context_.cell->kinematics(), reached_).inverse();
  Eigen::Vector3d z = X_BW.linear() * axis_W.direction;
  if (z.z() < 0.0) z = -z;
  // Neither the turn about the axis nor the shift along it shows in a cylinder: both stay nominal.
  const Eigen::Isometry3d nominal = context_.cell->nominal_part();
  const Eigen::Vector3d on_axis = X_BW * axis_W.point_mm;
  X_BP_.linear() =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), z).toRotationMatrix();
  X_BP_.translation() = on_axis + z * (nominal.translation() - on_axis).dot(z);
  geometry_ = path_geometry(context_.plan, feature_, 0.0);
}

core::Pose FeatureSession::levelling(const Eigen::Vector3d& direction_W) const {
  const Eigen::Matrix3d R =
      fixture::body_to_machine(context_.cell->kinematics(), reached_).linear();
  Eigen::Vector3d t_B = R.transpose() * direction_W;
  if (t_B.z() < 0.0) t_B = -t_B;
  return fixture::levelling_pose(t_B);
}

core::Result<void> FeatureSession::note(const std::string& text) {
  return context_.journal.add(record::Decision{index_, context_.cell->machine().time_s(), text});
}

void FeatureSession::show(double f_mm) {
  context_.progress.f_mm = f_mm;
  context_.show();
}

core::Result<std::vector<Eigen::Vector3d>> FeatureSession::touch_cloud(
    const std::vector<Target>& targets, record::Touch::Purpose purpose) {
  cmm::Machine& machine = context_.cell->machine();
  const Eigen::Isometry3d X_WP = part_at(reached_);
  Polyline way = entry_path(geometry_, targets.front());
  // Sideways only at park height; then straight down to above the part.
  Eigen::Vector3d above = X_WP * way.front();
  above.z() = std::max(above.z(), context_.plan.machine->park_mm[2]);
  if (auto moved = machine.move_to(above); !moved) return fault_at(targets.front(), moved.error());

  std::vector<Eigen::Vector3d> tips;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (i > 0) way = path_between(geometry_, targets[i - 1], targets[i]);
    if (auto moved = follow(machine, way, X_WP); !moved) return fault_at(targets[i], moved.error());
    auto tip = touch(targets[i], X_WP, purpose);
    if (!tip) {
      // The tip stands at the pre-touch point, except after a collision: then the machine has
      // stopped and only a person may move it.
      if (tip.error().code != core::Code::kCollision) {
        if (auto out = follow(machine, exit_path(geometry_, targets[i]), X_WP); out)
          (void)rise(context_.plan, machine);
      }
      return core::fail(tip.error());
    }
    tips.push_back(*tip);
  }
  if (auto moved = follow(machine, exit_path(geometry_, targets.back()), X_WP); !moved) {
    return fault_at(targets.back(), moved.error());
  }
  if (auto moved = rise(context_.plan, machine); !moved)
    return fault_at(targets.back(), moved.error());
  return tips;
}

core::Result<Eigen::Vector3d> FeatureSession::touch(const Target& target,
                                                    const Eigen::Isometry3d& X_WP,
                                                    record::Touch::Purpose purpose) {
  cmm::TouchCommand command;
  command.expected_tip_W_mm = X_WP * contact_tip(geometry_, target);
  command.direction_W = X_WP.linear() * approach_direction(geometry_, target);
  command.approach_mm = geometry_.approach_mm;
  command.search_mm =
      context_.plan.machine->search_mm + geometry_.approach_mm - context_.plan.machine->approach_mm;
  record::Touch row;
  row.purpose = purpose;
  row.pose = pose_id_;
  row.layer = target.layer;
  row.point = target.point;
  row.repeat = repeat_;
  const auto touched = context_.touch(command, row);
  if (!touched) return fault_at(target, touched.error());
  if (purpose == record::Touch::Purpose::kMeasure && repeat_ == 0) {
    truth_.push_back(context_.cell->true_tip_W_mm());
  }
  return touched->tip_mm;
}

}  // namespace rondure::plans
