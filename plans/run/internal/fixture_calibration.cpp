#include "plans/run/internal/fixture_calibration.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "fixture/axis_motion.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/internal/rotary_poses.h"
#include "plans/run/internal/qualification.h"

namespace rondure::plans {
namespace {

using core::kDegree;
using core::kMicrometre;
using fixture::kMicroradian;

constexpr double kTruthStep_deg = 2.0;

core::Result<void> touch_balls(RunContext& context, const record::RotaryTask& rotary,
                               const record::PoseVisit& visit, const RotaryVisit& wanted) {
  const Eigen::Isometry3d X_WB =
      fixture::body_to_machine(context.cell->kinematics(), visit.reached);
  for (const std::size_t ball : wanted.balls) {
    TRY(auto steps, ball_steps(context.plan, static_cast<std::size_t>(visit.feature), X_WB, ball));
    for (TouchStep& step : steps) step.row.pose = visit.id;
    const std::string name =
        fmt::format("ball {} in pose ({:g}, {:g}) deg", rotary.balls[ball].id,
                    wanted.pose.alpha_rad / kDegree, wanted.pose.beta_rad / kDegree);
    TRY_DO(touch_sphere_steps(context, steps, name));
  }
  return {};
}

/// The true errors of one axis over its stations.
record::Series truth_of(const Cell& cell, int feature, bool carried,
                        const std::vector<double>& stations_deg) {
  record::Series out;
  out.feature = feature;
  out.name = carried ? "beta" : "alpha";
  out.role = record::Series::Role::kTruth;
  out.columns = {{"angle_deg", "deg"},   {"shift_x_um", "um"},    {"shift_y_um", "um"},
                 {"shift_z_um", "um"},   {"tilt_x_urad", "urad"}, {"tilt_y_urad", "urad"},
                 {"tilt_z_urad", "urad"}};
  const auto [low, high] = std::minmax_element(stations_deg.begin(), stations_deg.end());
  const double from_deg = std::min(0.0, *low);
  const double arc_deg = std::max(0.0, *high) - from_deg;
  const int steps = static_cast<int>(std::ceil(arc_deg / kTruthStep_deg));
  for (int i = 0; i <= steps; ++i) {
    const double angle_deg = from_deg + arc_deg * i / steps;
    const auto errors = cell.true_errors(carried, angle_deg * kDegree);
    if (!errors) continue;
    out.values.push_back(angle_deg);
    for (const double t : errors->shift_mm) out.values.push_back(t / kMicrometre);
    for (const double w : errors->tilt_rad) out.values.push_back(w / kMicroradian);
  }
  return out;
}

core::Result<void> keep_truth(RunContext& context, int feature, const record::RotaryTask& rotary) {
  if (context.recorded.knows_series(feature)) return {};
  if (!context.cell->true_errors(false, 0.0)) return {};  // a real fixture has no known truth
  const std::vector<record::Series> truth = {
      truth_of(*context.cell, feature, false, rotary.alpha_stations_deg),
      truth_of(*context.cell, feature, true, rotary.beta_stations_deg)};
  return context.journal.add(truth, {});
}

}  // namespace

core::Result<std::vector<TouchStep>> ball_steps(const Plan& plan, std::size_t feature,
                                                const Eigen::Isometry3d& X_WB, std::size_t ball) {
  const record::RotaryTask& rotary = *plan.features[feature].rotary_axes;
  const record::BallTask& wanted = rotary.balls[ball];
  auto steps = sphere_steps(
      plan, {X_WB * vector3(wanted.center_mm), 0.5 * rotary.ball_diameter_mm, rotary.points,
             rotary.uncertainty_mm, record::Touch::Purpose::kMeasure, static_cast<int>(ball)});
  if (!steps) return steps;
  if (auto clear = check_sphere_steps(plan, plan.features[feature], X_WB, wanted.center_mm, 0.0,
                                      *steps, "ball " + wanted.id);
      !clear) {
    return core::fail(clear.error().at(fmt::format("/features/{}/rotary_axes/balls", feature)));
  }
  return steps;
}

std::size_t calibration_touches(const Plan& plan, std::size_t feature) {
  const auto visits = rotary_visits(plan, feature);
  if (!visits) return 0;
  std::size_t balls = 0;
  for (const RotaryVisit& visit : *visits) balls += visit.balls.size();
  return balls * static_cast<std::size_t>(plan.features[feature].rotary_axes->points);
}

core::Result<void> calibrate_fixture(RunContext& context, int feature_index) {
  const auto index = static_cast<std::size_t>(feature_index);
  const FeaturePlan& feature = context.plan.features[index];
  const record::RotaryTask& rotary = *feature.rotary_axes;
  TRY(const auto visits, rotary_visits(context.plan, index));
  context.progress.feature = feature.id;
  for (std::size_t i = 0; i < visits.size(); ++i) {
    TRY(const auto visit, context.turn(feature_index, visits[i].pose));
    context.progress.pose_number = static_cast<int>(i) + 1;
    context.progress.pose = visit.reached;
    if (auto touched = touch_balls(context, rotary, visit, visits[i]); !touched) return touched;
  }
  return keep_truth(context, feature_index, rotary);
}

}  // namespace rondure::plans
