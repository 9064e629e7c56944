#pragma once

#include "plans/analyses/spindle_plan.h"
#include "plans/schema/key_spec.h"

// The part of plan_table.h for features of the type "spindle" and their simulation.

namespace rondure::plans {

template <class Visitor>
void describe_probe_angles(Visitor& v, SpindlePlan& p) {
  v.text(
      "layout", p.layout,
      {.one_of = {"angles", "published-a", "published-b", "reference"},
       .meaning = "Where the three probes stand. angles: as p1_to_p2_deg and one of p2_to_p3_deg, "
                  "p1_to_p3_deg say. published-a, published-b: the layouts of the source; "
                  "reference: 52.38 and 248.91 deg, the least noise for orders 2 to 50."});
  v.number(
      "p1_to_p2_deg", p.p1_to_p2_deg,
      within(360.0,
             "From probe 1 to probe 2, against the rotation of the work; negative when counted "
             "with it."));
  v.number("p2_to_p3_deg", p.p2_to_p3_deg,
           within(360.0, "From probe 2 to probe 3 (a difference)."));
  v.number("p1_to_p3_deg", p.p1_to_p3_deg, within(360.0, "From probe 1 to probe 3 (cumulative)."));
}

template <class Visitor>
void describe_swing_arm(Visitor& v, SpindlePlan& p) {
  const auto radius = [](std::string_view meaning) {
    return NumberSpec{.at_least = 0.0,
                      .at_most = 2000.0,
                      .code = core::Code::kUnits,
                      .hint = "that suggests micrometres, give it in mm",
                      .meaning = meaning};
  };
  v.number(
      "crank_radius_mm", p.crank_radius_mm,
      radius("Distance of the pin from the rotation axis when the probes follow a crank pin on "
             "a swing arm (tracking); 0: an ordinary shaft (static)."));
  v.number("wheel_radius_mm", p.wheel_radius_mm,
           radius("Radius of the wheel whose centre is the pivot of the arm."));
  v.number("pin_radius_mm", p.pin_radius_mm,
           radius("Radius of the measured pin or shaft; the second-order correction needs it."));
}

template <class Visitor>
void describe_recovery(Visitor& v, SpindlePlan& p) {
  v.whole("samples", p.samples,
          range(8, 1'000'000,
                "Samples of a revolution, uniform in the angle on the part. More readings are "
                "low-passed to them: all count, none alias."));
  v.whole("highest_order", p.highest_order,
          range(2, 10'000, "Highest undulation number that is recovered; below half the samples."));
  v.number("greatest_gain", p.greatest_gain,
           range(1.0, 1e9, "A harmonic with a higher noise gain is not recovered but listed."));
  v.text(
      "recovery", p.recovery,
      {.one_of = {"threshold", "regularised"},
       .meaning = "threshold: harmonics are recovered whole or not at all. regularised: weak ones "
                  "are attenuated, and the report states by how much."});
  v.number("expected_amplitude_um", p.expected_amplitude_um,
           above(0.0, 1000.0, "Amplitude expected of a harmonic (recovery regularised)."));
  v.number("probe_noise_um", p.probe_noise_um,
           range(0.0, 1000.0,
                 "Standard deviation of one reading; left out: estimated from the scatter "
                 "of the revolutions, of one from the harmonics beyond highest_order."));
}

template <class Visitor>
void describe(Visitor& v, SpindlePlan& p) {
  describe_probe_angles(v, p);
  describe_swing_arm(v, p);
  describe_recovery(v, p);
  v.text(
      "resampling", p.resampling,
      {.one_of = {"on", "off"},
       .meaning = "off: readings are taken as uniform in the angle on the part, which is a gross "
                  "error for a crank pin; for comparison only."});
  v.text(
      "second_order", p.second_order,
      {.one_of = {"auto", "on", "off"},
       .meaning = "Correction for the sideways shift of the profile under a probe; auto: above 10 "
                  "um of motion."});
  v.text("motion", p.motion,
         {.one_of = {"least-squares", "as-published"},
          .meaning = "as-published: RY by the printed formula, which is wrong; for comparison "
                     "only."});
  v.text(
      "filter", p.filter,
      {.one_of = {"gaussian", "none"}, .meaning = "Filter of the profile before its roundness."});
  v.number("cutoff_upr", p.cutoff_upr, range(1.0, 10'000.0, "Cut-off of that filter."));
}

template <class Visitor>
void describe(Visitor& v, HarmonicPlan& p) {
  v.whole("order", p.order, required(range(0, 10'000, "Cycles a turn.")));
  v.number("amplitude_um", p.amplitude_um, range(0.0, 10'000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase: amplitude cos(order x - it)."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedSpindlePlan& p) {
  v.whole("turns", p.turns, range(1, 1000, "Revolutions recorded."));
  v.whole("samples_per_turn", p.samples_per_turn,
          range(8, 1'000'000, "Readings a revolution, in equal steps of the work angle."));
  v.list("profile", p.profile, {.meaning = "The part: undulations over the angle on the part."});
  v.list("motion_x", p.motion_x, {.meaning = "Motion of its centre, X, over the work angle."});
  v.list("motion_y", p.motion_y, {.meaning = "Motion of its centre, Y, over the work angle."});
  v.number("asynchronous_um", p.asynchronous_um,
           range(0.0, 10'000.0,
                 "Amplitude of a motion of 0.37 cycles a turn in X and Y, which does not repeat."));
  v.number("eccentricity_um", p.eccentricity_um,
           range(0.0, 10'000.0, "Of the part against its nominal centre."));
  v.number("eccentricity_deg", p.eccentricity_deg, within(360.0, "Its direction on the part."));
  v.number("probe_noise_um", p.probe_noise_um,
           range(0.0, 10'000.0, "Standard deviation of one reading."));
  v.numbers("probe_offset_um", p.probe_offset_um, within(10'000.0, "Zero error of each probe."));
  v.numbers("probe_gain_error", p.probe_gain_error,
            within(0.5, "Relative error of each probe's gain."));
  v.number("p2_error_deg", p.p2_error_deg, within(360.0, "Real minus stated place of probe 2."));
  v.number("p3_error_deg", p.p3_error_deg, within(360.0, "Real minus stated place of probe 3."));
}

}  // namespace rondure::plans
