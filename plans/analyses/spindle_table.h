#pragma once

#include "plans/analyses/spindle_plan.h"
#include "plans/schema/key_spec.h"

// The part of plan_table.h for features of the type "spindle" and their simulation.

namespace rondure::plans {

template <class Visitor>
void describe(Visitor& v, HarmonicPlan& p) {
  v.whole("order", p.order,
          {.at_least = 0, .at_most = 10'000, .required = true, .meaning = "Cycles a turn."});
  v.number("amplitude_um", p.amplitude_um,
           {.at_least = 0.0, .at_most = 10'000.0, .meaning = "Half of peak to valley."});
  v.number(
      "phase_deg", p.phase_deg,
      {.at_least = -360.0, .at_most = 360.0, .meaning = "Phase: amplitude cos(order x - it)."});
}

template <class Visitor>
void describe(Visitor& v, SimulatedSpindlePlan& p) {
  const auto um = [](std::string_view meaning) {
    return NumberSpec{.at_least = 0.0, .at_most = 10'000.0, .meaning = meaning};
  };
  const auto angle = [](std::string_view meaning) {
    return NumberSpec{.at_least = -360.0, .at_most = 360.0, .meaning = meaning};
  };
  v.whole("turns", p.turns, {.at_least = 1, .at_most = 1000, .meaning = "Revolutions recorded."});
  v.whole("samples_per_turn", p.samples_per_turn,
          {.at_least = 8,
           .at_most = 1'000'000,
           .meaning = "Readings a revolution, in equal steps of the work angle."});
  v.list("profile", p.profile, {.meaning = "The part: undulations over the angle on the part."});
  v.list("motion_x", p.motion_x, {.meaning = "Motion of its centre, X, over the work angle."});
  v.list("motion_y", p.motion_y, {.meaning = "Motion of its centre, Y, over the work angle."});
  v.number("asynchronous_um", p.asynchronous_um,
           um("Amplitude of a motion of 0.37 cycles a turn in X and Y, which does not repeat."));
  v.number("eccentricity_um", p.eccentricity_um, um("Of the part against its nominal centre."));
  v.number("eccentricity_deg", p.eccentricity_deg, angle("Its direction on the part."));
  v.number("probe_noise_um", p.probe_noise_um, um("Standard deviation of one reading."));
  v.numbers("probe_offset_um", p.probe_offset_um,
            {.at_least = -10'000.0, .at_most = 10'000.0, .meaning = "Zero error of each probe."});
  v.numbers("probe_gain_error", p.probe_gain_error,
            {.at_least = -0.5, .at_most = 0.5, .meaning = "Relative error of each probe's gain."});
  v.number("p2_error_deg", p.p2_error_deg, angle("Real minus stated place of probe 2."));
  v.number("p3_error_deg", p.p3_error_deg, angle("Real minus stated place of probe 3."));
}

}  // namespace rondure::plans
