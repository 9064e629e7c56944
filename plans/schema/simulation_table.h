#pragma once

#include "plans/contour_plan.h"
#include "plans/five_axis_plan.h"
#include "plans/key_spec.h"
#include "plans/machine_errors_plan.h"
#include "plans/plan.h"
#include "plans/rotary_plan.h"
#include "plans/spindle_plan.h"
#include "plans/wheel_plan.h"

// The part of plan_table.h for the hidden truth of a simulation.

namespace rondure::plans {

inline constexpr double kMaxSeed = 9007199254740991.0;  // 2^53 - 1: exact in every JSON reader

template <class Visitor>
void describe(Visitor& v, LobePlan& p) {
  v.whole("order", p.order, required(range(2, 500, "Undulations per revolution.")));
  v.number("amplitude_um", p.amplitude_um, range(0.0, 1000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase at mid-length."));
  v.number("twist_deg", p.twist_deg,
           within(3600.0, "Helix: change of phase from mid-length to the upper end."));
}

/// The form of a part, or of one of its surfaces.
template <class Visitor>
void describe_form(Visitor& v, SimulatedFormPlan& p) {
  v.number("diameter_error_um", p.diameter_error_um,
           within(1000.0, "Real minus nominal diameter."));
  v.list("lobes", p.lobes, {.meaning = "Lobing of the sections."});
  v.number("taper_um", p.taper_um,
           within(1000.0, "Radius at the upper end minus radius at mid-length."));
  v.number("barrel_um", p.barrel_um,
           within(1000.0, "Radius at the ends minus radius at mid-length; negative: a barrel."));
  v.number("bend_um", p.bend_um,
           within(1000.0, "Shift of the axis at the ends against mid-length."));
  v.number("bend_phase_deg", p.bend_phase_deg, within(360.0, "Direction of the bend."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedPartPlan& p) {
  describe_form(v, p);
  v.number("tilt_deg", p.tilt_deg, range(0.0, 45.0, "Tilt of the part in the clamping ring."));
  v.number("tilt_toward_deg", p.tilt_toward_deg,
           within(360.0, "Direction toward which its upper end leans."));
  v.number("offset_x_mm", p.offset_x_mm,
           within(100.0, "Shift of the part in the clamping ring, x."));
  v.number("offset_y_mm", p.offset_y_mm,
           within(100.0, "Shift of the part in the clamping ring, y."));
  v.number("expansion_per_K", p.expansion_per_K, range(0.0, 1e-4, "Real expansion of the part."));
  v.list("keyways", p.keyways, {.meaning = "Slots along the part."});
  v.list("burrs", p.burrs, {.meaning = "Raised spots."});
  v.number("dust_share", p.dust_share,
           range(0.0, 1.0, "Share of the touches of the part that meet a particle of dust."));
  v.number("dust_um", p.dust_um, range(0.0, 1000.0, "Thickness of the largest particle."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedFeaturePlan& p) {
  v.text("id", p.id,
         {.required = true, .empty_allowed = false, .meaning = "Id of the touched feature."});
  const NumberSpec offset =
      within(1000.0, "Middle of its axis, of a sphere its centre, against the part axis.");
  const NumberSpec slope = within(10'000.0, "Slope of its own axis against the part axis.");
  v.number("offset_x_um", p.offset_x_um, offset);
  v.number("offset_y_um", p.offset_y_um, offset);
  v.number("slope_x_urad", p.slope_x_urad, slope);
  v.number("slope_y_urad", p.slope_y_urad, slope);
  describe_form(v, p);
  v.list("keyways", p.keyways, {.meaning = "Slots along the surface."});
  v.list("flats", p.flats, {.meaning = "Worn or ground spots."});
  v.number("tilt_urad", p.tilt_urad,
           within(10'000.0, "plane: tilt of the face against the part axis."));
  v.number("tilt_toward_deg", p.tilt_toward_deg,
           within(360.0, "plane: direction in which the face rises, outward."));
  v.number("saucer_um", p.saucer_um,
           within(1000.0,
                  "plane: height at the outer diameter over the middle; it grows with the "
                  "square of the radius."));
  v.number("wave_um", p.wave_um,
           within(100.0, "plane: amplitude of the waves at the outer diameter."));
  v.whole("wave_order", p.wave_order, range(0, 15, "plane: waves per revolution."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedProbePlan& p) {
  v.number("repeatability_um", p.repeatability_um,
           range(0.0, 1000.0, "Standard deviation of one touch."));
  v.number("tip_radius_error_um", p.tip_radius_error_um,
           within(1000.0, "Effective minus nominal tip radius."));
  v.number("column_lean_deg", p.column_lean_deg,
           within(5.0, "Lean of the reference column toward machine x."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedFixturePlan& p) {
  const auto angle = [](double least, std::string_view meaning) {
    return range(least, 5.0, meaning);
  };
  v.numbers("axis_point_error_um", p.axis_point_error_um,
            within(10'000.0, "Real minus stated axis_point_mm."));
  v.numbers("axis_offset_error_um", p.axis_offset_error_um,
            within(10'000.0, "Real minus stated axis_offset_mm."));
  v.numbers("base_offset_mm", p.base_offset_mm,
            within(50.0, "Shift of the whole fixture on the table, with its reference spheres."));
  v.numbers("base_rotation_deg", p.base_rotation_deg,
            within(10.0, "Its turn about machine x, then y, then z, through the origin."));
  v.number("zero_alpha_deg", p.zero_alpha_deg, angle(-5.0, "Real alpha when the fixture reads 0."));
  v.number("zero_beta_deg", p.zero_beta_deg, angle(-5.0, "Real beta when the fixture reads 0."));
  v.number("squareness_deg", p.squareness_deg,
           angle(-5.0, "Departure of the two axes from 90 deg."));
  v.number("repeatability_deg", p.repeatability_deg,
           angle(0.0, "Standard deviation of a reached angle."));
  v.object(
      "motion", p.motion,
      {.meaning = "Six smooth errors of each axis, drawn; they are zero in the zero pose. Left "
                  "out: the axes turn truly."});
}

template <class Visitor>
void describe(Visitor& v, SimulatedFaultsPlan& p) {
  v.whole("connection_lost_at_touch", p.connection_lost_at_touch,
          range(0, 1'000'000'000,
                "The machine stops answering at this touch, counted from 1; 0: never."));
  v.whole("fixture_stalls_at_move", p.fixture_stalls_at_move,
          range(0, 1'000'000,
                "The fixture stalls on this move after its homing, counted from 1; 0: "
                "never."));
  v.number("part_moved_um", p.part_moved_um,
           within(1000.0, "Shift of the part in the ring, x, while the run is interrupted."));
  v.number("fixture_off_deg", p.fixture_off_deg,
           within(5.0,
                  "After the interruption the fixture stops so far beside the commanded alpha and "
                  "reads so."));
}

template <class Visitor>
void describe(Visitor& v, SimulationPlan& p) {
  v.whole("seed", p.seed, range(0, kMaxSeed, "Same seed, same noise; --seed overrides it."));
  v.number("temperature_degC", p.temperature_degC,
           range(10.0, 40.0, "Temperature of the simulated part."));
  v.object("part", p.part, {.meaning = "Form of the simulated part and how it sits in the ring."});
  v.list("features", p.features,
         {.meaning =
              "Surfaces with their own place and form; a tip then meets whichever comes first. A "
              "surface without an entry lies about the part axis and has the form of `part`."});
  v.object("machine", p.machine, {.meaning = "Errors of the simulated machine."});
  v.object("probe", p.probe, {.meaning = "Errors of the simulated probe."});
  v.object("fixture", p.fixture, {.meaning = "Errors of the simulated fixture."});
  v.object("faults", p.faults,
           {.meaning = "Interruptions of the simulated run. A resumed run meets none."});
  v.object("spindle", p.spindle,
           {.meaning = "Part and motion that the probes of a spindle feature see."});
  v.object("wheel", p.wheel, {.meaning = "The wheel whose edge points a wheel feature gets."});
  v.object("contour", p.contour,
           {.meaning = "Axis errors and parts that control and gauge of a contour feature see."});
  v.object("five_axis", p.five_axis,
           {.meaning = "The head whose readings a five_axis feature gets."});
}

}  // namespace rondure::plans
