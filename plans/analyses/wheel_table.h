#pragma once

#include "plans/analyses/wheel_plan.h"
#include "plans/schema/key_spec.h"
#include "record/tasks/wheel.h"

// The part of plan_table.h for features of the type "wheel" and their simulation.

namespace rondure::plans {

namespace wheel_specs = record::wheel_specs;

template <class Visitor>
void describe(Visitor& v, WheelLobePlan& p) {
  v.whole("order", p.order,
          {.at_least = 2, .at_most = 10'000, .required = true, .meaning = "Cycles a turn."});
  v.number("amplitude_um", p.amplitude_um,
           {.at_least = 0.0, .at_most = 10'000.0, .meaning = "Half of peak to valley."});
  v.number(
      "phase_deg", p.phase_deg,
      {.at_least = -360.0, .at_most = 360.0, .meaning = "Phase: amplitude cos(order theta - it)."});
}

template <class Visitor>
void describe(Visitor& v, SimulatedWheelPlan& p) {
  const auto um = [](std::string_view meaning) {
    return NumberSpec{.at_least = 0.0, .at_most = 10'000.0, .meaning = meaning};
  };
  const auto angle = [](std::string_view meaning) {
    return NumberSpec{.at_least = -360.0, .at_most = 360.0, .meaning = meaning};
  };
  v.number("radius_mm", p.radius_mm, wheel_specs::radius_mm(true, "True mean radius."));
  v.number("axis_x_mm", p.axis_x_mm, wheel_specs::place_mm("True spindle axis, x."));
  v.number("axis_z_mm", p.axis_z_mm, wheel_specs::place_mm("True spindle axis, z."));
  v.number("eccentricity_um", p.eccentricity_um, um("Of the wheel's centre from the axis."));
  v.number("eccentricity_deg", p.eccentricity_deg, angle("Its direction."));
  v.list("lobes", p.lobes, {.meaning = "Form of the edge about its centre."});
  v.number("noise_um", p.noise_um, um("Standard deviation of an edge point along the radius."));
  v.whole("points", p.points, {.at_least = 1, .at_most = 100'000, .meaning = "Edge points."});
  v.number("arc_from_deg", p.arc_from_deg, angle("First of them; even steps."));
  v.number("arc_to_deg", p.arc_to_deg, angle("Last of them; a whole turn has no point twice."));
  v.whole("chipped_point", p.chipped_point,
          {.at_least = 0, .at_most = 100'000, .meaning = "Point with a chip, from 1; 0: none."});
  v.number("chip_um", p.chip_um,
           {.at_least = -10'000.0, .at_most = 10'000.0, .meaning = "Its deviation."});
}

}  // namespace rondure::plans
