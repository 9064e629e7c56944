#pragma once

#include "plans/schema/key_spec.h"
#include "plans/wheel_plan.h"
#include "record/tasks/wheel.h"

// The part of plan_table.h for features of the type "wheel" and their simulation.

namespace rondure::plans {

namespace wheel_specs = record::wheel_specs;

template <class Visitor>
void describe(Visitor& v, WheelLobePlan& p) {
  v.whole("order", p.order, required(range(2, 10'000, "Cycles a turn.")));
  v.number("amplitude_um", p.amplitude_um, range(0.0, 10'000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase: amplitude cos(order theta - it)."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedWheelPlan& p) {
  v.number("radius_mm", p.radius_mm, wheel_specs::radius_mm(true, "True mean radius."));
  v.number("axis_x_mm", p.axis_x_mm, wheel_specs::place_mm("True spindle axis, x."));
  v.number("axis_z_mm", p.axis_z_mm, wheel_specs::place_mm("True spindle axis, z."));
  v.number("eccentricity_um", p.eccentricity_um,
           range(0.0, 10'000.0, "Of the wheel's centre from the axis."));
  v.number("eccentricity_deg", p.eccentricity_deg, within(360.0, "Its direction."));
  v.list("lobes", p.lobes, {.meaning = "Form of the edge about its centre."});
  v.number("noise_um", p.noise_um,
           range(0.0, 10'000.0, "Standard deviation of an edge point along the radius."));
  v.whole("points", p.points, range(1, 100'000, "Edge points."));
  v.number("arc_from_deg", p.arc_from_deg, within(360.0, "First of them; even steps."));
  v.number("arc_to_deg", p.arc_to_deg,
           within(360.0, "Last of them; a whole turn has no point twice."));
  v.whole("chipped_point", p.chipped_point,
          range(0, 100'000, "Point with a chip, from 1; 0: none."));
  v.number("chip_um", p.chip_um,
           within(10'000.0,
                  "Its deviation, part of the body and of its true run-out; above 0: a "
                  "proud grain."));
  v.number("chip_width_deg", p.chip_width_deg,
           above(0.0, 360.0, "Angle that it takes of the edge, about its point."));
}

}  // namespace rondure::plans
