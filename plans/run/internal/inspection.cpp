#include "plans/run/internal/inspection.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/shortest_turn.h"
#include "core/units.h"
#include "plans/analyses/features.h"
#include "plans/checks/internal/plan_reach.h"

namespace rondure::plans {
namespace {

/// Form, size and probing of a part are no displacement: more than they make of a touch.
constexpr double kFormOfPart_mm = 0.01;

/// The window in which a point lies; of a scan, one that crosses its layer.
const record::WindowTask* window_at(const FeaturePlan& feature, const Target& target) {
  if (feature.type == record::Shape::kPlane) return nullptr;  // its windows are of radii
  const bool scan = feature.sampling.method == record::SamplingMethod::kScan;
  for (const record::WindowTask& window : feature.exclude) {
    if (target.z_mm < window.from_mm.value_or(target.z_mm)) continue;
    if (target.z_mm > window.to_mm.value_or(target.z_mm)) continue;
    if (scan || !window.from_deg || !window.to_deg) return &window;
    const auto turned_deg = [&](double to_deg) {
      const double turn = std::fmod(to_deg - *window.from_deg, 360.0);
      return turn < 0.0 ? turn + 360.0 : turn;
    };
    if (turned_deg(core::degrees(target.theta_rad)) <= turned_deg(*window.to_deg)) return &window;
  }
  return nullptr;
}

/// A window leaves points out of the evaluation, not out of the path.
std::string window_advice(const Plan& plan, const FeaturePlan& feature, const Target& target) {
  const record::WindowTask* window = window_at(feature, target);
  if (window == nullptr) return {};
  if (feature.sampling.method == record::SamplingMethod::kScan) {
    return fmt::format(
        "; the window {} crosses this layer, and a scan goes through windows, too: where one is "
        "deeper than machine.search_mm ({:g} mm), raise search_mm, or plan the layers beside it",
        window->name, plan.machine->search_mm);
  }
  return fmt::format(
      "; the point lies in the window {}, and points in windows are touched, too: where one is "
      "deeper than machine.search_mm ({:g} mm), raise search_mm, or turn sampling.start_deg",
      window->name, plan.machine->search_mm);
}

}  // namespace

FeatureSession::FeatureSession(RunContext& context, int feature_index, std::vector<Target> targets)
    : context_(context),
      index_(feature_index),
      feature_(context.plan.features[static_cast<std::size_t>(feature_index)]),
      targets_(std::move(targets)),
      X_BP_(context.cell->nominal_part()),
      geometry_(path_geometry(context.plan, feature_, context.location_mm())),
      planner_(context.plan, feature_) {
  context_.progress.feature = feature_.id;
}

const fixture::FixtureLimits& FeatureSession::limits() const {
  return context_.cell->fixture().limits();
}

Eigen::Isometry3d FeatureSession::part_at(const core::Pose& pose) const {
  return fixture::body_to_machine(context_.cell->kinematics(), pose) * X_BP_;
}

tl::unexpected<core::Error> FeatureSession::fault_at(const Target& target,
                                                     const core::Error& error) const {
  // A stop by the operator and a journal that cannot be written are not tied to a point.
  if (error.code == core::Code::kStopped || error.code == core::Code::kJournal) {
    return core::fail(error);
  }
  std::string advice;
  const bool stands = is_fixed(context_.plan) && !context_.part_met;
  if (stands && error.code == core::Code::kNoTouch) {
    advice = fmt::format(
        "; the part is not within {:g} mm of its place in the plan; nothing else has moved",
        context_.plan.machine->search_mm + geometry_.approach_mm -
            context_.plan.machine->approach_mm);
  }
  if (error.code == core::Code::kNoTouch || error.code == core::Code::kCollision) {
    advice +=
        "; check that the part of the plan is clamped where the plan says "
        "(location_uncertainty_mm)";
  }
  if (error.code == core::Code::kNoTouch) advice += window_advice(context_.plan, feature_, target);
  if (error.code == core::Code::kCollision)
    advice += ", and move the tip clear by hand before the next run";
  return core::fail_with(error.code, "feature {}, layer {}, point {}: {}{}", feature_.id,
                         target.layer + 1, target.point + 1, error.what, advice);
}

core::Pose FeatureSession::commanded_for(const core::Pose& wanted) const {
  core::Pose out = fixture::commanded_for(context_.cell->kinematics(), wanted);
  out.alpha_rad = std::clamp(out.alpha_rad, limits().min_alpha_rad, limits().max_alpha_rad);
  out.beta_rad = std::clamp(out.beta_rad, limits().min_beta_rad, limits().max_beta_rad);
  return out;
}

bool FeatureSession::must_locate() const { return context_.location_mm() > 0.0; }

core::Result<void> FeatureSession::turn(const core::Pose& commanded,
                                        const std::vector<Target>& targets) {
  TRY_DO(lay(targets, commanded));
  commanded_ = commanded;
  TRY(const auto visit, context_.turn(index_, commanded));
  reached_ = visit.reached;
  repeat_ = 0;
  pose_id_ = visit.id;
  context_.progress.pose_number = ++visits_;
  if (!is_fixed(context_.plan)) context_.progress.pose = reached_;
  return {};
}

Eigen::Vector3d FeatureSession::expected_axis() const {
  return part_at(reached_).linear() * Eigen::Vector3d::UnitZ();
}

core::Result<void> FeatureSession::check_place(const Target& target, const TouchStep& step,
                                               const Eigen::Vector3d& tip_W_mm) {
  const bool locates = step.row.purpose == record::Touch::Purpose::kLocate;
  if (!is_fixed(context_.plan) || (context_.part_met && !locates)) return {};
  const bool first = !context_.part_met;
  const double search_mm = context_.plan.machine->search_mm;
  const double location_mm = geometry_.location_mm;
  const bool located = location_mm > 0.0 && location_mm < search_mm;
  const double late_mm = (tip_W_mm - step.command.expected_tip_W_mm).dot(step.command.direction_W);
  context_.part_met = std::abs(late_mm) <= (located ? location_mm + kFormOfPart_mm : search_mm);
  if (context_.part_met) return {};
  return core::fail_with(
      core::Code::kLocation,
      "feature {}, layer {}, point {}: {} touch met the part {:.3f} mm {} its place in the plan, "
      "{} allows {:g} mm; {}; correct part.position_mm and part.axis, or place the part anew",
      feature_.id, target.layer + 1, target.point + 1, first ? "the first" : "a", std::abs(late_mm),
      late_mm < 0.0 ? "before" : "beyond",
      located ? "part.location_uncertainty_mm" : "machine.search_mm",
      located ? location_mm : search_mm, first ? "nothing else has moved" : "nothing was measured");
}

core::Result<void> FeatureSession::check_displacement(const fit::Axis& found) const {
  if (!is_fixed(context_.plan)) return {};
  const Eigen::Isometry3d X_WP = fixture::body_to_machine(context_.cell->kinematics(), reached_) *
                                 context_.cell->nominal_part();
  const double middle_mm = 0.5 * (feature_.nominal.from_mm + feature_.nominal.to_mm);
  const Eigen::Vector3d expected = X_WP * Eigen::Vector3d(0.0, 0.0, middle_mm);
  const Eigen::Vector3d& along = found.direction;
  const Eigen::Vector3d off =
      found.point_mm + along * along.dot(expected - found.point_mm) - expected;
  const double allowed_mm = context_.plan.part.location_uncertainty_mm;
  if (off.norm() <= allowed_mm + kFormOfPart_mm) return {};
  return core::fail_with(
      core::Code::kLocation,
      "feature {}: the part stands {:.3f} mm from its place in the plan, by ({:.3f}, {:.3f}, "
      "{:.3f}) mm in machine x, y, z; part.location_uncertainty_mm allows {:g} mm; nothing was "
      "measured; correct part.position_mm and part.axis, or place the part anew",
      feature_.id, off.norm(), off.x(), off.y(), off.z(), allowed_mm);
}

core::Result<void> FeatureSession::check_location(const fit::LsCylinder& found) const {
  const double allowed = context_.plan.part.location_uncertainty_mm;
  const auto refuse = [&](const char* what, double value) {
    return core::fail_with(
        core::Code::kLocation,
        "feature {}: the {} of the located part differs by {:.3f} mm, the plan allows {:g} mm "
        "(location_uncertainty_mm); check the part and its clamping, nothing was measured",
        feature_.id, what, value, allowed);
  };
  const double sign = geometry_.inside ? -1.0 : 1.0;
  const double radius = found.radius_mm - sign * geometry_.tip_radius_mm;
  if (!(std::abs(radius - geometry_.radius_mm) <= allowed)) {
    return refuse("radius", std::abs(radius - geometry_.radius_mm));
  }
  if (!(found.deviation_mm <= allowed)) return refuse("form", found.deviation_mm);
  const double cosine = std::min(1.0, std::abs(found.axis.direction.dot(expected_axis())));
  const double half_mm = 0.5 * (feature_.nominal.to_mm - feature_.nominal.from_mm);
  const double reach = half_mm * std::sqrt(1.0 - cosine * cosine);
  if (!(reach <= allowed)) return refuse("end of the axis", reach);
  return check_displacement(found.axis);
}

core::Result<fit::Axis> FeatureSession::locate_once(const core::Pose& commanded) {
  TRY(const auto targets, locating_targets(feature_, context_.plan.part.location_uncertainty_mm));
  TRY_DO(turn(commanded, targets));
  TRY(const auto tips, touch_cloud(targets, record::Touch::Purpose::kLocate));
  TRY(const auto cylinder, fit::ls_cylinder(tips, expected_axis()));
  TRY_DO(check_location(cylinder));
  follow_axis(cylinder.axis);
  return cylinder.axis;
}

core::Result<double> FeatureSession::locate_height() {
  TRY(const auto targets, height_targets(feature_));
  TRY_DO(turn({}, targets));
  TRY(const auto tips, touch_cloud(targets, record::Touch::Purpose::kLocate));
  const Eigen::Isometry3d X_PW = part_at(reached_).inverse();
  double sum_mm = 0.0;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    sum_mm += (X_PW * tips[i] - contact_tip(geometry_, targets[i])).z();
  }
  return sum_mm / static_cast<double>(tips.size());
}

core::Result<fit::Axis> FeatureSession::locate(const core::Pose& commanded) {
  for (;;) {
    auto axis = locate_once(commanded);
    if (axis || !context_.relocation_due) return axis;
    context_.relocation_due = false;  // it moved again while being located: start again
  }
}

core::Result<void> FeatureSession::locate_again() {
  context_.relocation_due = false;
  geometry_ = path_geometry(context_.plan, feature_, context_.plan.part.location_uncertainty_mm);
  TRY_DO(locate(commanded_));
  return {};
}

core::Result<std::vector<Eigen::Vector3d>> FeatureSession::turn_and_touch(
    const core::Pose& commanded) {
  for (;;) {
    TRY_DO(turn(commanded, reach_targets()));
    auto tips = measure_cloud();
    if (tips || !context_.relocation_due || merging()) return tips;
    TRY_DO(locate_again());
  }
}

core::Result<Cloud> FeatureSession::measure(const core::Pose& commanded) {
  TRY(auto tips, turn_and_touch(commanded));
  return Cloud{reached_, std::move(tips)};
}

core::Result<Cloud> FeatureSession::measure_reachable(const core::Pose& commanded) {
  if (!merging()) all_targets_ = targets_;
  targets_ =
      planner_.reachable(all_targets_, geometry_,
                         fixture::body_to_machine(context_.cell->kinematics(), commanded), X_BP_);
  if (targets_.size() < kLeastTargets) {
    return core::fail(core::Code::kUnreachable, too_few_targets(commanded, targets_.size()));
  }
  return measure(commanded);
}

core::Result<void> FeatureSession::repeat(int times) {
  for (int i = 0; i < times; ++i) {
    ++repeat_;
    const auto tips = measure_cloud();
    if (tips) continue;
    if (!context_.relocation_due || merging()) return core::fail(tips.error());
    // Repeats the whole final cloud: touches of two placements are never merged.
    if (auto located = locate_again(); !located) return located;
    TRY_DO(turn_and_touch(commanded_));
    if (auto kept = keep_as_final(); !kept) return kept;
    i = -1;
  }
  return {};
}

core::Result<void> FeatureSession::keep_as_final() {
  const record::PoseVisit* known = context_.recorded.pose(pose_id_);
  if (known == nullptr || !known->final_cloud) {
    if (auto marked = context_.journal.mark_final(pose_id_); !marked) return marked;
  }
  return {};
}

void FeatureSession::follow_axis(const fit::Axis& axis_W) {
  const Eigen::Isometry3d X_BW =
      fixture::body_to_machine(context_.cell->kinematics(), reached_).inverse();
  Eigen::Vector3d z = X_BW.linear() * axis_W.direction;
  const Eigen::Isometry3d nominal = context_.cell->nominal_part();
  const Eigen::Vector3d expected = nominal.linear().col(2);
  if (z.dot(expected) < 0.0) z = -z;  // a cylinder's axis has two directions
  // A cylinder shows neither the rotation about its axis nor the shift along it: both stay nominal.
  const Eigen::Vector3d on_axis = X_BW * axis_W.point_mm;
  X_BP_.linear() = core::shortest_turn(expected, z) * nominal.linear();
  X_BP_.translation() = on_axis + z * (nominal.translation() - on_axis).dot(z);
  geometry_ = path_geometry(context_.plan, feature_, 0.0);
}

core::Pose FeatureSession::levelling(const Eigen::Vector3d& direction_W) const {
  const Eigen::Matrix3d R =
      fixture::body_to_machine(context_.cell->kinematics(), reached_).linear();
  Eigen::Vector3d t_B = R.transpose() * direction_W;
  if (t_B.z() < 0.0) t_B = -t_B;
  return fixture::levelling_pose(context_.cell->kinematics(), t_B);
}

core::Result<void> FeatureSession::note(const core::Message& decision) {
  return context_.note(index_, decision);
}

void FeatureSession::show(double f_mm) {
  context_.progress.f_mm = f_mm;
  context_.show();
}

core::Result<CloudPath> FeatureSession::lay(const std::vector<Target>& targets,
                                            const core::Pose& pose) {
  return planner_.lay(targets, geometry_,
                      fixture::body_to_machine(context_.cell->kinematics(), pose), X_BP_);
}

TouchStep FeatureSession::step_to(const CloudPath& path, std::size_t k,
                                  record::Touch::Purpose purpose) const {
  const Target& target = path.target(k);
  const Eigen::Isometry3d X_WP = part_at(reached_);
  TouchStep step;
  step.command.expected_tip_W_mm = X_WP * contact_tip(geometry_, target);
  step.command.direction_W = X_WP.linear() * approach_direction(geometry_, target);
  step.command.approach_mm = geometry_.approach_mm;
  step.command.search_mm =
      context_.plan.machine->search_mm + geometry_.approach_mm - context_.plan.machine->approach_mm;
  step.row.purpose = purpose;
  step.row.pose = pose_id_;
  step.row.layer = target.layer;
  step.row.point = target.point;
  step.row.repeat = repeat_;
  step.entry_W = path.entry_W(k);
  step.way_W = path.way_W(k);
  return step;
}

void FeatureSession::leave(const CloudPath& path, std::size_t k) {
  if (auto out = context_.follow(path.exit_W(k)); out) (void)context_.rise();
}

core::Result<void> FeatureSession::visit(const CloudPath& path, record::Touch::Purpose purpose,
                                         bool by_layer, const Measure& measure) {
  context_.last_steps.clear();
  const std::size_t last = path.order().size() - 1;
  for (std::size_t k = 0; k <= last; ++k) {
    const Target& target = path.target(k);
    TouchStep step = step_to(path, k, purpose);
    context_.doing = fmt::format("{}, layer {}", feature_.id, target.layer + 1);
    if (!by_layer) context_.doing += fmt::format(", point {}", target.point + 1);
    if (auto moved = context_.follow(step.way_W); !moved) {
      // Refused by the operator: the tip is back at the previous touch. After a fault it stays
      // there.
      if (context_.retreating && k > 0) leave(path, k - 1);
      return fault_at(target, moved.error());
    }
    if (auto done = measure(std::move(step), k); !done) {
      // The tip is at the pre-touch point, except after a collision: then the machine has stopped
      // and only a person may move it. If a relocation is due, it is at park height already.
      const bool standing = done.error().code != core::Code::kCollision;
      if (standing && !context_.lost_place && !context_.relocation_due) leave(path, k);
      return done;
    }
  }
  context_.doing = fmt::format("{}, back to park height", feature_.id);
  if (auto moved = context_.follow(path.exit_W(last)); !moved) {
    if (context_.retreating) leave(path, last);
    return fault_at(path.target(last), moved.error());
  }
  if (auto moved = context_.rise(); !moved) return fault_at(path.target(last), moved.error());
  return {};
}

core::Result<std::vector<Eigen::Vector3d>> FeatureSession::touch_cloud(
    const std::vector<Target>& targets, record::Touch::Purpose purpose) {
  TRY(const auto path, lay(targets, reached_));
  std::vector<Eigen::Vector3d> tips(targets.size());
  const auto touch = [&](const TouchStep& step, std::size_t k) -> core::Result<void> {
    const auto touched = context_.touch(step);
    if (!touched) {
      return context_.lost_place ? core::fail(touched.error())
                                 : fault_at(path.target(k), touched.error());
    }
    TRY_DO(check_place(path.target(k), step, touched->tip_mm));
    tips[path.order()[k]] = touched->tip_mm;
    return {};
  };
  TRY_DO(visit(path, purpose, false, touch));
  return tips;
}

}  // namespace rondure::plans
