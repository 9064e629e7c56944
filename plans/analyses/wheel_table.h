#pragma once

#include "plans/analyses/wheel_plan.h"
#include "plans/schema/key_spec.h"

// The part of plan_table.h for features of the type "wheel" and their simulation.

namespace rondure::plans {

namespace wheel_specs {

inline NumberSpec place_mm(std::string_view meaning) { return within(10'000.0, meaning); }

inline NumberSpec radius_mm(bool required, std::string_view meaning) {
  return {.at_least = 0.5,
          .at_most = 1000.0,
          .required = required,
          .code = core::Code::kUnits,
          .hint = "that suggests another unit, give it in mm",
          .meaning = meaning};
}

}  // namespace wheel_specs

template <class Visitor>
void describe_surface_form(Visitor& v, GroundSurfacePlan& p) {
  v.text("form", p.form,
         {.one_of = {"polynomial", "asphere", "table"},
          .required = true,
          .meaning = "Surface z = f(x) [mm], material below, wheel above. polynomial: "
                     "coefficients; asphere: vertex_radius_mm, conic, even_terms; table: "
                     "table_x_mm, table_z_mm."});
  v.numbers("coefficients", p.coefficients,
            within(1e9, "a0, a1, a2, ... of a polynomial in x [mm]."));
  v.number("vertex_radius_mm", p.vertex_radius_mm,
           within(1e7, "Of an asphere, 1/c; above 0: hollow; left out: a plane with even terms."));
  v.number("conic", p.conic, within(1e4, "K: 0 a sphere, -1 a paraboloid."));
  v.numbers("even_terms", p.even_terms, within(1e9, "A2, A4, A6, ... of an asphere."));
  v.numbers("table_x_mm", p.table_x_mm,
            wheel_specs::place_mm("x of a table, rising; five places or more."));
  v.numbers("table_z_mm", p.table_z_mm, wheel_specs::place_mm("z of a table."));
  v.numbers("removal_x_mm", p.removal_x_mm,
            wheel_specs::place_mm("x of a depth that is taken off the surface."));
  v.numbers("removal_depth_um", p.removal_depth_um, range(0.0, 1e6, "That depth."));
}

template <class Visitor>
void describe(Visitor& v, GroundSurfacePlan& p) {
  describe_surface_form(v, p);
  NumberSpec end = wheel_specs::place_mm("First contact, x.");
  end.required = true;
  v.number("from_mm", p.from_mm, end);
  end.meaning = "Last contact, x.";
  v.number("to_mm", p.to_mm, end);
  v.number("step_mm", p.step_mm, above(0.0, 1000.0, "Step of x."));
  v.number("cusp_um", p.cusp_um,
           above(0.0, 1000.0, "Highest cusp between passes; gives the step in place of step_mm."));
  v.text("radius", p.radius,
         {.one_of = {"mean", "effective"},
          .meaning = "Radius of the path. effective: of the point farthest from the axis, which "
                     "makes the surface when run-out matters."});
  v.number("wheel_arc_from_deg", p.wheel_arc_from_deg,
           within(90.0, "Trued arc of the wheel, from its lowest point: begin."));
  v.number("wheel_arc_to_deg", p.wheel_arc_to_deg, within(90.0, "End of the trued arc."));
  v.number("repeatability_um", p.repeatability_um,
           range(0.0, 1000.0, "Of the grinding machine: no compensation is better."));
  v.number("touch_off_mm", p.touch_off_mm,
           wheel_specs::place_mm("x where the depth is touched off; left out: 0."));
}

template <class Visitor>
void describe(Visitor& v, WheelPlan& p) {
  v.text("mode", p.mode,
         {.one_of = {"indexed", "envelope"},
          .required = true,
          .empty_allowed = false,
          .meaning = "indexed: wheel at rest at known angles, points of its body. envelope: wheel "
                     "at speed, points of the circle it sweeps; shows no run-out."});
  v.number("nominal_radius_mm", p.nominal_radius_mm,
           wheel_specs::radius_mm(false,
                                  "Nominal radius; R must be within 5 % of it. The "
                                  "characteristic radius needs it."));
  v.number("axis_x_mm", p.axis_x_mm,
           wheel_specs::place_mm("Spindle axis, from calibration; run-out needs it."));
  v.number("axis_z_mm", p.axis_z_mm, wheel_specs::place_mm("The same, z."));
  v.text("center", p.center,
         {.one_of = {"least-squares", "as-published", "weighted"},
          .meaning = "least-squares: of all points. as-published: plain mean of the centres of "
                     "quadruples; weighted: the same, by conditioning."});
  v.text("quadruples", p.quadruples,
         {.one_of = {"all", "best", "random"},
          .meaning = "all; best: the `count` best conditioned; random: as published."});
  v.whole("count", p.count, range(6, 5000, "Quadruples of best and random."));
  v.number("kappa_limit", p.kappa_limit,
           range(1.0, 1e9, "Worst conditioning accepted; left out: 5, or twice the best."));
  v.text("robust", p.robust,
         {.one_of = {"off", "on"}, .meaning = "on: isolated points beyond 5 scales are dropped."});
  v.text("short_arc", p.short_arc,
         {.one_of = {"refused", "allowed"}, .meaning = "Less than 20 deg of the circle."});
  v.object("surface", p.surface, {.meaning = "A surface to grind: gives the wheel-centre path."});
}

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
  v.number("chip_um", p.chip_um, within(10'000.0, "Its deviation."));
}

}  // namespace rondure::plans
