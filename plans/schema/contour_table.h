#pragma once

#include "plans/contour_plan.h"
#include "plans/schema/key_spec.h"
#include "plans/schema/spindle_table.h"

// The part of plan_table.h for features of the type "contour" and their simulation.

namespace rondure::plans {

template <class Visitor>
void describe(Visitor& v, ContourPartPlan& p) {
  v.text("name", p.name, {.meaning = "What the part is called in the report."});
  v.text("axes", p.axes,
         {.required = true,
          .empty_allowed = false,
          .meaning = "CSV of the control, columns c_deg,c_error_deg,x_error_mm, with d_cmd_mm "
                     "(commanded X) to check crank, wheel and the zero of C; relative to the "
                     "plan."});
  v.text("pin", p.pin,
         {.required = true,
          .empty_allowed = false,
          .meaning = "CSV of the gauge, columns angle_deg,deviation_um: the pin."});
  v.text("main", p.main,
         {.meaning = "The same of the neighbouring main journal; left out: not measured."});
}

template <class Visitor>
void describe_crank(Visitor& v, ContourPlan& p) {
  const auto radius = [](std::string_view meaning) {
    return NumberSpec{.at_least = 0.1,
                      .at_most = 2000.0,
                      .code = core::Code::kUnits,
                      .hint = "that suggests metres or micrometres, give it in mm",
                      .meaning = meaning};
  };
  v.number("crank_radius_mm", p.crank_radius_mm, radius("Distance of the pin from the axis, R."));
  v.number("wheel_radius_mm", p.wheel_radius_mm, radius("Radius of the grinding wheel, Rgw."));
  v.number("pin_radius_mm", p.pin_radius_mm, radius("Radius of the pin, r."));
  v.number("main_radius_mm", p.main_radius_mm, radius("Radius of the main journals."));
}

template <class Visitor>
void describe_senses(Visitor& v, ContourPlan& p) {
  v.text("error", p.error,
         {.one_of = {"actual-minus-command", "command-minus-actual"},
          .meaning = "Sign of the axis errors; most controls record command minus actual as "
                     "following error."});
  v.text("c_axis", p.c_axis,
         {.one_of = {"with-wheel", "against-wheel"},
          .meaning = "with-wheel: C is the polar angle of the wheel seen from the crankshaft; "
                     "against-wheel: C counts the other way."});
  v.text("gauge", p.gauge,
         {.one_of = {"counter-clockwise", "clockwise"},
          .meaning = "Sense of the gauge's angles, seen as C."});
  v.number(
      "phase_offset_deg", p.phase_offset_deg,
      within(360.0, "Gauge angle of the direction from the crankshaft's axis to the pin's: pins."));
  v.number("main_phase_offset_deg", p.main_phase_offset_deg,
           within(360.0, "The same: main journals."));
}

template <class Visitor>
void describe(Visitor& v, ContourPlan& p) {
  describe_crank(v, p);
  v.text("method", p.method,
         {.one_of = {"corrected", "as-published"},
          .meaning = "as-published: each following part is turned onto its total by correlation; "
                     "for comparison only."});
  describe_senses(v, p);
  v.whole("samples", p.samples, range(16, 100'000, "Points of a contour."));
  v.whole("path_samples", p.path_samples,
          range(16, 100'000, "C positions the traces are brought to."));
  v.text(
      "filter", p.filter,
      {.one_of = {"gaussian", "none", "done-by-gauge"},
       .meaning = "Low pass of all contours; done-by-gauge: pins and mains are filtered already, "
                  "the following part is filtered alike."});
  v.number("cutoff_upr", p.cutoff_upr, range(1.0, 10'000.0, "Cut-off of that filter."));
  v.number("pre_filter_upr", p.pre_filter_upr,
           range(0.0, 10'000.0, "Gaussian low pass of the axis errors first; 0: none."));
  v.text("base_circle", p.base_circle,
         {.one_of = {"limacon", "geometric"}, .meaning = "How the base circle is taken away."});
  v.text("main_journal", p.main_journal,
         {.one_of = {"as-is", "mapped"},
          .meaning = "mapped: carried to the pin as n(alpha(beta)) cos(eta)."});
  v.number("stable_from", p.stable_from,
           range(0.0, 1.0, "Stability index from which on it is stable."));
  v.number("partly_from", p.partly_from,
           range(0.0, 1.0, "Stability index from which on it is partly."));
  v.list("parts", p.parts, {.meaning = "The ground parts; left out: simulated."});
}

template <class Visitor>
void describe(Visitor& v, AngleHarmonicPlan& p) {
  v.whole("order", p.order, required(range(0, 10'000, "Cycles a turn.")));
  v.number("amplitude_mdeg", p.amplitude_mdeg, range(0.0, 1000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase: amplitude cos(order x - it)."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedContourPlan& p) {
  v.whole("parts", p.parts, range(1, 100, "Parts ground."));
  v.number("speed_rpm", p.speed_rpm, above(0.0, 1000.0, "Turns of C a minute."));
  v.number("sampling_ms", p.sampling_ms,
           above(0.0, 1000.0, "From sample to sample of the control."));
  v.number("turns", p.turns, range(1.0, 100.0, "Turns recorded."));
  v.list("c_error", p.c_error, {.meaning = "Error of C over the command angle."});
  v.list("x_error", p.x_error, {.meaning = "Error of X over the command angle."});
  v.number(
      "c_error_spread", p.c_error_spread,
      range(0.0, 1.0, "Standard deviation of the relative size of C errors from part to part."));
  v.list("rest", p.rest, {.meaning = "Non-following part of every pin, over the angle beta."});
  v.number("rest_spread_um", p.rest_spread_um,
           range(0.0, 1000.0,
                 "Standard deviation of the amplitudes of orders 2 to 6 that differ from part to "
                 "part."));
  v.number("c_noise_mdeg", p.c_noise_mdeg,
           range(0.0, 1000.0, "Standard deviation of one C sample."));
  v.number("x_noise_um", p.x_noise_um, range(0.0, 1000.0, "Standard deviation of one X sample."));
  v.number("roughness_um", p.roughness_um,
           range(0.0, 1000.0, "Standard deviation of one gauge value."));
  v.whole("gauge_points", p.gauge_points, range(360, 100'000, "Values of one gauge contour."));
}

}  // namespace rondure::plans
