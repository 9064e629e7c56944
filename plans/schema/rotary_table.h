#pragma once

#include "core/error.h"
#include "plans/rotary_plan.h"
#include "plans/schema/key_spec.h"

// The part of plan_table.h for features of the type "rotary_axes", for the simulated errors that
// they determine, and for the calibration that other runs use.

namespace rondure::plans {

template <class Visitor>
void describe(Visitor& v, CalibrationPlan& p) {
  v.text("file", p.file,
         {.empty_allowed = false,
          .meaning = "fixture-calibration.json of a run that calibrated this fixture, relative to "
                     "the plan. This or `feature`."});
  v.text("feature", p.feature,
         {.empty_allowed = false,
          .meaning = "Id of the feature of this plan that calibrates the fixture for those after "
                     "it."});
  v.number("max_age_days", p.max_age_days,
           range(0.0, 36'500.0, "An older calibration is refused, whatever it says of itself."));
  v.number("max_residual_um", p.max_residual_um,
           above(0.0, 10'000.0, "A calibration with more at a combined pose is refused."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedMotionPlan& p) {
  v.number(
      "offset_um", p.offset_um,
      range(0.0, 10'000.0, "Distance of each axis from its stated place, in a drawn direction."));
  v.number("tilt_urad", p.tilt_urad, range(0.0, 10'000.0, "Tilt of each axis."));
  v.number("shift_um", p.shift_um,
           range(0.0, 10'000.0, "Amplitude of further shifts that depend on the angle."));
  v.number("turn_urad", p.turn_urad, range(0.0, 10'000.0, "The same of the turns."));
  v.whole("seed", p.seed,
          range(0, 9007199254740991.0, "Seed of the draw; --seed does not change it."));
}

}  // namespace rondure::plans
