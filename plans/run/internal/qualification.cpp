#include "plans/run/internal/qualification.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/least_squares/sphere.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/scene.h"

namespace rondure::plans {
namespace {

constexpr double kMostLean_deg = 2.0;

core::Result<void> check_limits(const fit::ProbeTip& tip, const ProbePlan& plan) {
  const double nominal = 0.5 * plan.tip_diameter_mm;
  const QualificationPlan& limits = plan.qualification;
  if (!(tip.radius_mm > 0.0) ||
      std::abs(tip.radius_mm - nominal) > limits.radius_tolerance_um * core::kMicrometre) {
    return core::fail_with(
        core::Code::kCalibration,
        "effective tip radius {:.6f} mm differs from the nominal {:g} mm by more than {:g} um: "
        "check tip_diameter_mm and the certified diameter of the {}",
        tip.radius_mm, nominal, limits.radius_tolerance_um, limits.name());
  }
  const double lean_deg = tip.lean_rad() / core::kDegree;
  if (lean_deg > kMostLean_deg) {
    return core::fail_with(core::Code::kCalibration,
                           "the reference column leans {:.2f} deg, the limit is {:g} deg: set it "
                           "upright",
                           lean_deg, kMostLean_deg);
  }
  if (tip.form_mm > limits.form_limit_um * core::kMicrometre) {
    return core::fail_with(core::Code::kCalibration,
                           "probing form {:.3f} um is above its limit of {:g} um: clean tip and "
                           "sphere, check that both are tight, and run again",
                           tip.form_mm / core::kMicrometre, limits.form_limit_um);
  }
  return {};
}

core::Result<Eigen::Vector3d> touch_sphere(RunContext& context, const TouchStep& step,
                                           const std::string& point) {
  const auto touched = context.touch(step);
  if (touched) return touched->tip_mm;
  if (touched.error().code == core::Code::kStopped || context.lost_place) {
    return core::fail(touched.error());
  }
  return core::fail_with(touched.error().code, "{}: {}", point, touched.error().what);
}

}  // namespace

core::Result<std::vector<Eigen::Vector3d>> touch_sphere_steps(RunContext& context,
                                                              const std::vector<TouchStep>& steps,
                                                              const std::string& name) {
  context.last_steps.clear();
  std::vector<Eigen::Vector3d> tips;
  for (const TouchStep& step : steps) {
    const std::string point = fmt::format("{}, point {}", name, step.row.point + 1);
    context.doing = point;
    if (auto moved = context.follow(step.way_W); !moved) {
      if (context.retreating) (void)context.rise();
      if (moved.error().code != core::Code::kCollision) return core::fail(moved.error());
      return core::fail_with(core::Code::kCollision, "{}: {}", point, moved.error().what);
    }
    auto tip = touch_sphere(context, step, point);
    if (!tip) {
      const bool movable = tip.error().code != core::Code::kCollision && !context.lost_place;
      if (movable) (void)context.rise();
      return core::fail(tip.error());
    }
    tips.push_back(*tip);
  }
  context.doing = "back to park height";
  if (auto moved = context.rise(); !moved) {
    if (context.retreating) (void)context.rise();
    return core::fail(moved.error());
  }
  return tips;
}

core::Result<std::vector<std::vector<Eigen::Vector3d>>> touch_spheres(
    RunContext& context, const std::vector<TouchStep>& steps,
    const std::function<std::string(std::size_t)>& name) {
  std::vector<std::vector<Eigen::Vector3d>> tips;
  std::vector<TouchStep> of_one;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    of_one.push_back(steps[i]);
    if (i + 1 < steps.size() && steps[i + 1].row.layer == steps[i].row.layer) continue;
    TRY(auto touched, touch_sphere_steps(context, of_one, name(tips.size())));
    tips.push_back(std::move(touched));
    of_one.clear();
  }
  return tips;
}

core::Result<Eigen::Vector3d> sphere_center(const Plan& plan,
                                            const std::vector<Eigen::Vector3d>& tips,
                                            const std::string& name) {
  TRY(const auto found, fit::ls_sphere(tips));
  const double limit_um = plan.probe->qualification.form_limit_um;
  if (found.deviation_mm <= limit_um * core::kMicrometre) return found.center_mm;
  return core::fail_with(core::Code::kCalibration,
                         "{} has a form of {:.3f} um, the limit is {:g} um (form_limit_um); clean "
                         "it and check that it is tight",
                         name, found.deviation_mm / core::kMicrometre, limit_um);
}

core::Result<std::vector<TouchStep>> sphere_steps(const Plan& plan, const SphereToTouch& sphere) {
  TRY(const auto directions, qualification_directions(sphere.points));
  const Eigen::Vector3d& center = sphere.center_W_mm;
  PathGeometry geometry;
  geometry.tip_radius_mm = 0.5 * plan.probe->tip_diameter_mm;
  geometry.approach_mm = plan.machine->approach_mm + sphere.uncertainty_mm;
  geometry.clearance_mm = plan.machine->clearance_mm + sphere.uncertainty_mm;
  const double reach_mm = sphere.radius_mm + geometry.tip_radius_mm;

  // From park height straight down to the pole; from there around the sphere.
  const Eigen::Vector3d pole = center + (reach_mm + geometry.approach_mm) * directions.front();
  const Polyline down = {{pole.x(), pole.y(), std::max(pole.z(), plan.machine->park_mm[2])}, pole};
  std::vector<TouchStep> steps;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Eigen::Vector3d& outward = directions[i];
    const auto around = [&](const Eigen::Vector3d& from) {
      return path_around_sphere(center, sphere.radius_mm, geometry, from, outward);
    };
    TouchStep step;
    step.command.expected_tip_W_mm = center + reach_mm * outward;
    step.command.direction_W = -outward;
    step.command.approach_mm = geometry.approach_mm;
    step.command.search_mm = plan.machine->search_mm + sphere.uncertainty_mm;
    step.row.purpose = sphere.purpose;
    step.row.layer = sphere.layer;
    step.row.point = static_cast<int>(i);
    step.entry_W = down;
    step.way_W = i == 0 ? down : around(directions[i - 1]);
    if (i > 0) {
      const Polyline way = around(directions.front());
      step.entry_W.insert(step.entry_W.end(), way.begin(), way.end());
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

core::Result<void> check_sphere_steps(const Plan& plan, const FeaturePlan& feature,
                                      const Eigen::Isometry3d& X_WB,
                                      const std::array<double, 3>& center_mm, double off_mm,
                                      const std::vector<TouchStep>& steps,
                                      const std::string& name) {
  const Scene scene(plan, feature, &center_mm);
  const Eigen::Isometry3d X_WN = X_WB * nominal_seat(*plan.fixture);
  PathGeometry geometry;
  geometry.location_mm = off_mm + (is_touched(feature) ? plan.part.location_uncertainty_mm : 0.0);
  geometry.clearance_mm = plan.machine->clearance_mm + geometry.location_mm;
  for (const TouchStep& step : steps) {
    // A run that goes on comes in by entry_W; one that ends rises from where it stands.
    Polyline there = step.way_W;
    there.push_back(step.command.expected_tip_W_mm);
    there.push_back(step.way_W.back());
    there.push_back(step.way_W.back());
    there.back().z() = std::max(there.back().z(), plan.machine->park_mm[2]);
    for (const Polyline& corners : {there, step.entry_W}) {
      const Way way = {corners, std::vector<Phase>(corners.size() - 1, Phase::kTravel)};
      const auto hit = scene.first_hit(way, {X_WN, X_WN}, geometry);
      if (!hit) continue;
      return core::fail_with(core::Code::kUnreachable, "{}, point {}: {}", name, step.row.point + 1,
                             in_words(*hit));
    }
  }
  return {};
}

std::vector<TouchStep> round_steps(const Plan& plan, const RoundToTouch& round) {
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  const double out = round.inside ? -1.0 : 1.0;
  const double reach_mm = round.radius_mm + out * tip_mm;
  const double approach_mm =
      round.inside ? reach_mm : plan.machine->approach_mm + round.uncertainty_mm;
  const double apart_mm = reach_mm + out * approach_mm;  // a hole is touched from its axis
  const double step_rad = core::kTwoPi / round.points;
  const auto at = [&](double radius_mm, double angle_rad, double height_mm) {
    return Eigen::Vector3d(round.foot_W_mm + Eigen::Vector3d(radius_mm * std::cos(angle_rad),
                                                             radius_mm * std::sin(angle_rad),
                                                             height_mm));
  };
  std::vector<TouchStep> steps;
  const int heights = static_cast<int>(round.heights_mm.size());
  for (int k = 0; k < heights; ++k) {
    const double height_mm = round.heights_mm[static_cast<std::size_t>(k)];
    for (int i = 0; i < round.points; ++i) {
      const double angle_rad = i * step_rad;
      const Eigen::Vector3d before = at(apart_mm, angle_rad, height_mm);
      TouchStep step;
      step.command.direction_W = out * (round.foot_W_mm - at(1.0, angle_rad, 0.0));
      step.command.expected_tip_W_mm = at(reach_mm, angle_rad, height_mm);
      step.command.approach_mm = approach_mm;
      step.command.search_mm = plan.machine->search_mm + round.uncertainty_mm;
      step.row.purpose = round.purpose;
      step.row.layer = round.layer < 0 ? heights - 1 - k : round.layer;
      step.row.point = static_cast<int>(steps.size());
      step.entry_W = {{before.x(), before.y(), std::max(before.z(), plan.machine->park_mm[2])},
                      before};
      step.way_W = step.entry_W;
      if (!steps.empty()) {
        const Eigen::Vector3d last = steps.back().way_W.back();
        Eigen::Vector3d corner =
            at(apart_mm / std::cos(0.5 * step_rad), angle_rad - 0.5 * step_rad, 0.0);
        corner.z() = last.z();
        step.way_W = {last, corner, {before.x(), before.y(), last.z()}};
        if (i == 0) step.way_W.push_back(before);
      }
      steps.push_back(std::move(step));
    }
  }
  return steps;
}

namespace {

std::vector<TouchStep> column_steps(const Plan& plan) {
  const QualificationPlan& q = plan.probe->qualification;
  RoundToTouch column = {
      vector3(q.column_point_mm), 0.5 * q.column_diameter_mm, false, {}, q.points_per_height};
  for (int k = q.heights - 1; k >= 0; --k) {
    column.heights_mm.push_back(q.column_from_mm +
                                (q.column_to_mm - q.column_from_mm) * (k + 0.5) / q.heights);
  }
  return round_steps(plan, column);
}

}  // namespace

core::Result<std::vector<TouchStep>> qualification_steps(const Plan& plan) {
  const QualificationPlan& q = plan.probe->qualification;
  TRY(auto steps, q.on_column() ? core::Result<std::vector<TouchStep>>(column_steps(plan))
                                : sphere_steps(plan, {vector3(q.sphere_center_mm),
                                                      0.5 * q.sphere_diameter_mm, q.points, 0.0}));
  const auto X_WB = fixture::body_to_machine(nominal_kinematics(*plan.fixture), {});
  TRY_DO(check_sphere_steps(plan, plan.features.front(), X_WB, q.place_mm(), 0.0, steps, q.name()));
  return steps;
}

core::Result<fit::ProbeTip> qualify_probe(RunContext& context) {
  const QualificationPlan& q = context.plan.probe->qualification;
  TRY(const auto steps, qualification_steps(context.plan));
  TRY(const auto tips, touch_sphere_steps(context, steps, q.name()));
  TRY(const auto tip, q.on_column() ? fit::qualify_tip_on_column(tips, 0.5 * q.diameter_mm())
                                    : fit::qualify_tip(tips, 0.5 * q.diameter_mm()));
  TRY_DO(check_limits(tip, *context.plan.probe));
  return tip;
}

}  // namespace rondure::plans
