#pragma once

#include <vector>

#include "plans/key_spec.h"
#include "record/tasks/wheel.h"

namespace rondure::plans {

// The keys of the simulation of a feature of the type "wheel", named as in the JSON; see plan.h.
// The keys of the feature itself: record/tasks/wheel.h.

struct WheelLobePlan {
  int order = 2;
  double amplitude_um = 0.0;
  double phase_deg = 0.0;
};

/// Hidden truth of a simulated wheel.
struct SimulatedWheelPlan {
  double radius_mm = 0.0;
  double axis_x_mm = 0.0;
  double axis_z_mm = 0.0;
  double eccentricity_um = 0.0;  ///< Eccentricity of the profile's centre from the axis.
  double eccentricity_deg = 0.0;
  std::vector<WheelLobePlan> lobes;  ///< amplitude cos(order theta - phase).
  double noise_um = 0.0;
  int points = 12;
  double arc_from_deg = 0.0;
  double arc_to_deg = 360.0;
  int chipped_point = 0;  ///< Number of the point in the middle of the chip, from 1; 0: none.
  double chip_um = 0.0;   ///< > 0: a proud grain.
  double chip_width_deg = 1.0;
};

// Keys and meanings of features of the type "wheel" and their simulation.

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
