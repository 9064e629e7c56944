#include "plans/run/internal/fixture_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "core/units.h"
#include "fixture/axis_motion.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/path/internal/rotary_poses.h"
#include "plans/run/internal/datum_holes.h"
#include "plans/run/internal/qualification.h"

namespace rondure::plans {
namespace {

using Eigen::Vector3d;

constexpr const char* kDatumPointer = "/fixture/datum";

core::Result<Vector3d> center_near_nominal(const Plan& plan, std::size_t sphere,
                                           const std::vector<Vector3d>& tips) {
  const DatumPlan& datum = *plan.fixture->datum;
  const auto center = sphere_center(plan, tips, datum_name(datum, sphere));
  if (!center) return core::fail(center.error().at(kDatumPointer));
  const double off_mm = (*center - vector3(datum.spheres[sphere].center_mm)).norm();
  if (off_mm <= datum.uncertainty_mm) return *center;
  return core::fail(core::Code::kLocation,
                    fmt::format("{} stands {:.3f} mm from its nominal place, the plan allows "
                                "{:g} mm (uncertainty_mm); check where the fixture is bolted",
                                datum_name(datum, sphere), off_mm, datum.uncertainty_mm),
                    kDatumPointer);
}

core::Result<std::vector<TouchStep>> reference_sphere_steps(const Plan& plan, std::size_t index) {
  const DatumPlan& datum = *plan.fixture->datum;
  return sphere_steps(
      plan, {vector3(datum.spheres[index].center_mm), 0.5 * datum.sphere_diameter_mm, datum.points,
             datum.uncertainty_mm, record::Touch::Purpose::kLocate, static_cast<int>(index)});
}

/// Where the plan has what a layer touches.
const std::array<double, 3>& place_of(const DatumPlan& datum, std::size_t layer) {
  if (!datum.on_holes()) return datum.spheres[layer].center_mm;
  return layer == 0 ? datum.seat.front().point_mm : datum.holes[layer - 1].center_mm;
}

}  // namespace

std::string datum_name(const DatumPlan& datum, std::size_t layer) {
  if (!datum.on_holes()) return fmt::format("sphere {} of the fixture", layer + 1);
  if (layer == 0) return "the seat of the fixture";
  const bool inside = datum.holes[layer - 1].side == record::Side::kInside;
  return fmt::format("{} {} of the fixture", inside ? "hole" : "dowel or bolt head", layer);
}

core::Message base_message(const fit::Registration& base) {
  const Vector3d shift = base.motion.translation();
  const Eigen::AngleAxisd turn(base.motion.rotation());
  const Vector3d angles = turn.angle() * turn.axis() / core::kDegree;
  return {core::MessageCode::kFixtureBaseFound,
          {shift.x(), shift.y(), shift.z(), angles.x(), angles.y(), angles.z(),
           base.largest_residual_mm / core::kMicrometre}};
}

core::Result<std::vector<TouchStep>> datum_steps(const Plan& plan) {
  std::vector<TouchStep> out;
  if (!plan.fixture->datum) return out;
  const DatumPlan& datum = *plan.fixture->datum;
  const auto clamped = std::find_if(plan.features.begin(), plan.features.end(), needs_machine);
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(nominal_kinematics(*plan.fixture), {});
  for (std::size_t layer = 0; layer < datum.layers(); ++layer) {
    auto steps = datum.on_holes() ? core::Result<std::vector<TouchStep>>(layer_steps(plan, layer))
                                  : reference_sphere_steps(plan, layer);
    if (!steps) return core::fail(steps.error().at(kDatumPointer));
    if (auto clear = check_sphere_steps(plan, *clamped, X_WB, place_of(datum, layer),
                                        datum.uncertainty_mm, *steps, datum_name(datum, layer));
        !clear) {
      return core::fail(clear.error().at(kDatumPointer));
    }
    std::move(steps->begin(), steps->end(), std::back_inserter(out));
  }
  return out;
}

core::Result<fit::Registration> fixture_base(const Plan& plan,
                                             std::span<const std::vector<Vector3d>> tips_W_mm,
                                             double tip_radius_mm) {
  const DatumPlan& datum = *plan.fixture->datum;
  if (datum.on_holes()) {
    auto base = base_from_holes(plan, tips_W_mm, tip_radius_mm);
    if (!base) return core::fail(base.error().at(kDatumPointer));
    return base;
  }
  std::vector<Vector3d> nominal;
  std::vector<Vector3d> found;
  for (std::size_t i = 0; i < tips_W_mm.size(); ++i) {
    TRY(const auto center, center_near_nominal(plan, i, tips_W_mm[i]));
    nominal.push_back(vector3(datum.spheres[i].center_mm));
    found.push_back(center);
  }
  const auto base = fit::rigid_registration(nominal, found);
  if (!base) return core::fail(base.error().at(kDatumPointer));
  if (base->largest_residual_mm > datum.residual_limit_um * core::kMicrometre) {
    return core::fail(
        core::Code::kCalibration,
        fmt::format(
            "the spheres of the fixture fit their nominal places to {:.3f} um, the limit is "
            "{:g} um (residual_limit_um); check their certified centres and that none is "
            "loose",
            base->largest_residual_mm / core::kMicrometre, datum.residual_limit_um),
        kDatumPointer);
  }
  return *base;
}

core::Result<void> find_fixture_base(RunContext& context, double tip_radius_mm) {
  TRY(auto steps, datum_steps(context.plan));
  if (steps.empty()) return {};
  const DatumPlan& datum = *context.plan.fixture->datum;
  TRY(const auto tips,
      touch_spheres(context, steps, [&](std::size_t i) { return datum_name(datum, i); }));
  TRY(const auto base, fixture_base(context.plan, tips, tip_radius_mm));
  context.cell->set_base(base.motion);
  const core::Message found = base_message(base);
  if (context.recorded.has_decision(found)) return {};
  return context.journal.add(record::Decision{-1, context.cell->machine().time_s(), found});
}

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
