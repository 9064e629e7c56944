#include "plans/run/internal/fixture_base.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>

#include "core/units.h"
#include "fit/geometry/axis.h"
#include "fit/least_squares/circle.h"
#include "fit/least_squares/plane.h"
#include "fixture/axis_motion.h"
#include "plans/analyses/features.h"
#include "plans/path/internal/nominal_geometry.h"
#include "plans/run/internal/qualification.h"

namespace rondure::plans {
namespace {

using core::Code;
using core::kMicrometre;
using Eigen::Vector3d;

constexpr const char* kDatumPointer = "/fixture/datum";
constexpr double kOtherHole_mm = 0.2;  // of the diameter

/// What a layer of datum_steps() touches, for messages: "sphere 2 of the fixture".
std::string datum_name(const DatumPlan& datum, std::size_t layer) {
  if (!datum.on_holes()) return fmt::format("sphere {} of the fixture", layer + 1);
  if (layer == 0) return "the seat of the fixture";
  const bool inside = datum.holes[layer - 1].side == record::Side::kInside;
  return fmt::format("{} {} of the fixture", inside ? "hole" : "dowel or bolt head", layer);
}

std::vector<TouchStep> seat_steps(const Plan& plan) {
  const DatumPlan& datum = *plan.fixture->datum;
  const double tip_mm = 0.5 * plan.probe->tip_diameter_mm;
  std::vector<TouchStep> steps;
  for (const DatumSeatPlan& at : datum.seat) {
    TouchStep step;
    step.command.direction_W = -Vector3d::UnitZ();
    step.command.expected_tip_W_mm = vector3(at.point_mm) + tip_mm * Vector3d::UnitZ();
    step.command.approach_mm = plan.machine->approach_mm + datum.uncertainty_mm;
    step.command.search_mm = plan.machine->search_mm + datum.uncertainty_mm;
    step.row.purpose = record::Touch::Purpose::kLocate;
    step.row.layer = 0;
    step.row.point = static_cast<int>(steps.size());
    const Vector3d before =
        step.command.expected_tip_W_mm + step.command.approach_mm * Vector3d::UnitZ();
    const Vector3d above(before.x(), before.y(), std::max(before.z(), plan.machine->park_mm[2]));
    step.entry_W = {above, before};
    step.way_W = step.entry_W;
    if (!steps.empty()) {
      const Vector3d last = steps.back().way_W.back();
      step.way_W.insert(step.way_W.begin(), {last.x(), last.y(), above.z()});
    }
    steps.push_back(std::move(step));
  }
  return steps;
}

/// From the axis of the hole, the highest height first.
std::vector<TouchStep> steps_of_hole(const Plan& plan, std::size_t index) {
  const DatumPlan& datum = *plan.fixture->datum;
  const DatumHolePlan& hole = datum.holes[index];
  RoundToTouch round;
  round.foot_W_mm = vector3(hole.center_mm);
  round.radius_mm = 0.5 * hole.diameter_mm;
  round.inside = hole.side == record::Side::kInside;
  const double foot_mm = round.inside ? -hole.depth_mm : 0.0;
  for (int k = datum.heights - 1; k >= 0; --k)
    round.heights_mm.push_back(foot_mm + hole.depth_mm * (k + 0.5) / datum.heights);
  round.points = datum.points;
  round.uncertainty_mm = datum.uncertainty_mm;
  round.purpose = record::Touch::Purpose::kLocate;
  round.layer = static_cast<int>(index) + 1;
  return round_steps(plan, round);
}

core::Result<std::vector<TouchStep>> reference_sphere_steps(const Plan& plan, std::size_t index) {
  const DatumPlan& datum = *plan.fixture->datum;
  return sphere_steps(
      plan, {vector3(datum.spheres[index].center_mm), 0.5 * datum.sphere_diameter_mm, datum.points,
             datum.uncertainty_mm, record::Touch::Purpose::kLocate, static_cast<int>(index)});
}

core::Result<std::vector<TouchStep>> layer_steps(const Plan& plan, std::size_t layer) {
  if (!plan.fixture->datum->on_holes()) return reference_sphere_steps(plan, layer);
  return layer == 0 ? seat_steps(plan) : steps_of_hole(plan, layer - 1);
}

/// Where the plan has what a layer touches.
const std::array<double, 3>& place_of(const DatumPlan& datum, std::size_t layer) {
  if (!datum.on_holes()) return datum.spheres[layer].center_mm;
  return layer == 0 ? datum.seat.front().point_mm : datum.holes[layer - 1].center_mm;
}

/// The limit on how far a reference may be from its nominal place.
core::Result<void> near_place(const DatumPlan& datum, std::size_t layer, double off_mm) {
  if (off_mm <= datum.uncertainty_mm) return {};
  return core::fail_with(Code::kLocation,
                         "{} stands {:.3f} mm from its nominal place, the plan allows {:g} mm "
                         "(uncertainty_mm); check where the fixture is bolted",
                         datum_name(datum, layer), off_mm, datum.uncertainty_mm);
}

core::Result<fit::Registration> base_from_spheres(
    const Plan& plan, std::span<const std::vector<Vector3d>> tips_W_mm) {
  const DatumPlan& datum = *plan.fixture->datum;
  std::vector<Vector3d> nominal;
  std::vector<Vector3d> found;
  for (std::size_t i = 0; i < tips_W_mm.size(); ++i) {
    TRY(const auto center, sphere_center(plan, tips_W_mm[i], datum_name(datum, i)));
    nominal.push_back(vector3(datum.spheres[i].center_mm));
    TRY_DO(near_place(datum, i, (center - nominal.back()).norm()));
    found.push_back(center);
  }
  TRY(const auto base, fit::rigid_registration(nominal, found));
  if (base.largest_residual_mm <= datum.residual_limit_um * kMicrometre) return base;
  return core::fail_with(
      Code::kCalibration,
      "the spheres of the fixture fit their nominal places to {:.3f} um, the limit is "
      "{:g} um (residual_limit_um); check their certified centres and that none is "
      "loose",
      base.largest_residual_mm / kMicrometre, datum.residual_limit_um);
}

tl::unexpected<core::Error> uneven(const std::string& name, double form_mm, double limit_um) {
  return core::fail_with(
      Code::kCalibration,
      "{} has a form of {:.3f} um, the limit is {:g} um (residual_limit_um); clean it, "
      "and check that the fixture is tight",
      name, form_mm / kMicrometre, limit_um);
}

/// The plane of the seat, through the points that were touched.
core::Result<fit::Plane> seat_plane(const DatumPlan& datum, const std::vector<Vector3d>& tips,
                                    double tip_radius_mm) {
  TRY(auto found, fit::ls_plane(tips, Vector3d(Vector3d::UnitZ())));
  if (found.deviation_mm > datum.residual_limit_um * kMicrometre)
    return uneven(datum_name(datum, 0), found.deviation_mm, datum.residual_limit_um);
  found.plane.point_mm -= tip_radius_mm * found.plane.normal;
  for (std::size_t i = 0; i < datum.seat.size(); ++i) {
    const double off_mm = fit::height_mm(found.plane, vector3(datum.seat[i].point_mm));
    if (std::abs(off_mm) <= datum.uncertainty_mm) continue;
    return core::fail_with(
        Code::kLocation,
        "the seat of the fixture is {:.3f} mm from place {} of it, the plan allows {:g} mm "
        "(uncertainty_mm); check where the fixture is bolted",
        std::abs(off_mm), i + 1, datum.uncertainty_mm);
  }
  return found.plane;
}

/// Where the axis of a hole meets the plane of the seat.
core::Result<Vector3d> hole_center(const DatumPlan& datum, std::size_t index,
                                   const std::vector<Vector3d>& tips, const fit::Plane& seat,
                                   double tip_radius_mm) {
  const DatumHolePlan& hole = datum.holes[index];
  const std::string name = datum_name(datum, index + 1);
  const Eigen::Matrix<double, 3, 2> along = fit::across(seat.normal);
  std::vector<Eigen::Vector2d> seen;
  for (const Vector3d& tip : tips) seen.emplace_back(along.transpose() * (tip - seat.point_mm));
  TRY(const auto circle, fit::ls_circle(seen));
  const double ball_mm = hole.side == record::Side::kInside ? tip_radius_mm : -tip_radius_mm;
  const double diameter_mm = 2.0 * (circle.radius_mm + ball_mm);
  if (!(std::abs(diameter_mm - hole.diameter_mm) <= kOtherHole_mm)) {
    return core::fail_with(
        Code::kCalibration,
        "{} has a diameter of {:.3f} mm, the plan says {:g} mm, and up to {:g} mm are taken "
        "for the same; check its number and diameter_mm",
        name, diameter_mm, hole.diameter_mm, kOtherHole_mm);
  }
  if (circle.deviation_mm > datum.residual_limit_um * kMicrometre)
    return uneven(name, circle.deviation_mm, datum.residual_limit_um);
  const Vector3d center = seat.point_mm + along * circle.center_mm;
  const Vector3d nominal = vector3(hole.center_mm);
  TRY_DO(near_place(datum, index + 1, (center - nominal).head<2>().norm()));
  return center;
}

/// The plane of the seat gives the normal and the height, its holes the turn and the shift within
/// it. A plane from hole axes, which the source allows as well, is not offered: two heights 10 mm
/// apart, each found to 1 um, give it to 140 urad, a seat of 180 mm to some 10 urad, and axes say
/// nothing about the height. Source: methods, machine cell section 6.2.
core::Result<fit::Registration> base_from_holes(const Plan& plan,
                                                std::span<const std::vector<Vector3d>> tips_W_mm,
                                                double tip_radius_mm) {
  const DatumPlan& datum = *plan.fixture->datum;
  TRY(const auto seat, seat_plane(datum, tips_W_mm[0], tip_radius_mm));
  std::vector<Vector3d> nominal;
  std::vector<Vector3d> found;
  for (std::size_t i = 0; i < datum.holes.size(); ++i) {
    TRY(const auto center, hole_center(datum, i, tips_W_mm[i + 1], seat, tip_radius_mm));
    nominal.emplace_back(datum.holes[i].center_mm[0], datum.holes[i].center_mm[1],
                         datum.seat.front().point_mm[2]);
    found.push_back(center);
  }
  TRY(const auto base, fit::plane_registration(nominal, found, seat));
  if (base.largest_residual_mm <= datum.residual_limit_um * kMicrometre) return base;
  std::size_t worst = 0;
  const auto off_mm = [&](std::size_t i) { return (base.motion * nominal[i] - found[i]).norm(); };
  for (std::size_t i = 1; i < found.size(); ++i) worst = off_mm(i) > off_mm(worst) ? i : worst;
  return core::fail_with(
      Code::kCalibration,
      "{} is {:.3f} um off the place that all of them give it, the limit is {:g} um "
      "(residual_limit_um); check the certified centres, and their order",
      datum_name(datum, worst + 1), base.largest_residual_mm / kMicrometre,
      datum.residual_limit_um);
}

}  // namespace

core::Message base_message(const fit::Registration& base) {
  const Vector3d shift = base.motion.translation();
  const Eigen::AngleAxisd turn(base.motion.rotation());
  const Vector3d angles = turn.angle() * turn.axis() / core::kDegree;
  return {core::MessageCode::kFixtureBaseFound,
          {shift.x(), shift.y(), shift.z(), angles.x(), angles.y(), angles.z(),
           base.largest_residual_mm / kMicrometre}};
}

core::Result<std::vector<TouchStep>> datum_steps(const Plan& plan) {
  std::vector<TouchStep> out;
  if (!plan.fixture->datum) return out;
  const DatumPlan& datum = *plan.fixture->datum;
  const auto clamped = std::find_if(plan.features.begin(), plan.features.end(), needs_machine);
  const Eigen::Isometry3d X_WB = fixture::body_to_machine(nominal_kinematics(*plan.fixture), {});
  for (std::size_t layer = 0; layer < datum.layers(); ++layer) {
    auto steps = layer_steps(plan, layer);
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

/// What every path keeps clear of stands where the plan has it, to uncertainty_mm.
core::Result<void> near_nominal(const Plan& plan, const Eigen::Isometry3d& X_WF) {
  const FixturePlan& fixture = *plan.fixture;
  const double allowed_mm = fixture.datum->uncertainty_mm;
  const auto check = [&](const std::string& name, const Vector3d& at) -> core::Result<void> {
    const double off_mm = (X_WF * at - at).norm();
    if (off_mm <= allowed_mm) return {};
    return core::fail_with(Code::kLocation,
                           "the fixture stands so that {} is {:.3f} mm from its nominal place, the "
                           "plan allows {:g} mm (uncertainty_mm), which every path keeps; check "
                           "where the fixture is bolted",
                           name, off_mm, allowed_mm);
  };
  const Vector3d axis = vector3(fixture.axis_point_mm);
  TRY_DO(check("the point of its axes", axis));
  const double rim_mm = 0.5 * fixture.rim_diameter_mm;
  for (const Vector3d& out : {Vector3d(rim_mm, 0, 0), Vector3d(-rim_mm, 0, 0),
                              Vector3d(0, rim_mm, 0), Vector3d(0, -rim_mm, 0)})
    TRY_DO(check("its rim", Vector3d(axis.x(), axis.y(), fixture.rim_height_mm) + out));
  for (const BodyPlan& body : fixture.bodies) {
    if (body.frame != BodyPlan::Frame::kBase) continue;
    for (const Vector3d& corner : corners_of(body))
      TRY_DO(check(fmt::format("its body \"{}\"", body.id), corner));
  }
  return {};
}

core::Result<fit::Registration> fixture_base(const Plan& plan,
                                             std::span<const std::vector<Vector3d>> tips_W_mm,
                                             double tip_radius_mm) {
  auto base = plan.fixture->datum->on_holes() ? base_from_holes(plan, tips_W_mm, tip_radius_mm)
                                              : base_from_spheres(plan, tips_W_mm);
  if (!base) return core::fail(base.error().at(kDatumPointer));
  if (auto near = near_nominal(plan, base->motion); !near)
    return core::fail(near.error().at(kDatumPointer));
  return base;
}

core::Result<void> find_fixture_base(RunContext& context, double tip_radius_mm) {
  TRY(auto steps, datum_steps(context.plan));
  if (steps.empty()) return {};
  const DatumPlan& datum = *context.plan.fixture->datum;
  const auto tips =
      touch_spheres(context, steps, [&](std::size_t i) { return datum_name(datum, i); });
  if (!tips) {
    core::Error error = tips.error();
    if (error.code == Code::kCollision || error.code == Code::kNoTouch) {
      error.what += fmt::format(
          "; the fixture may stand farther off than {:g} mm (fixture.datum.uncertainty_mm): check "
          "where it is bolted",
          datum.uncertainty_mm);
    }
    return core::fail(std::move(error));
  }
  TRY(const auto base, fixture_base(context.plan, *tips, tip_radius_mm));
  context.cell->set_base(base.motion);
  const core::Message found = base_message(base);
  if (context.recorded.has_decision(found)) return {};
  return context.journal.add(record::Decision{-1, context.cell->machine().time_s(), found});
}

}  // namespace rondure::plans
