#pragma once

#include "core/error.h"
#include "plans/rotary_plan.h"
#include "plans/schema/key_spec.h"

// The part of plan_table.h for features of the type "rotary_axes", for the simulated errors that
// they determine, and for the calibration that other runs use.

namespace rondure::plans {

template <class Visitor>
void describe(Visitor& v, BallPlan& p) {
  v.text("id", p.id,
         {.required = true,
          .empty_allowed = false,
          .meaning = "Name of the ball in the report, unique."});
  v.numbers("center_mm", p.center_mm,
            within(1000.0, "Nominal centre: x, y, z in the frame of the clamping ring."));
}

template <class Visitor>
void describe(Visitor& v, CombinedPosePlan& p) {
  const auto angle = [](std::string_view meaning) {
    return NumberSpec{.at_least = -90.0,
                      .at_most = 90.0,
                      .required = true,
                      .code = core::Code::kPoseRange,
                      .meaning = meaning};
  };
  v.number("alpha_deg", p.alpha_deg, angle("About the base-fixed axis; not 0."));
  v.number("beta_deg", p.beta_deg, angle("About the carried axis; not 0."));
}

template <class Visitor>
void describe(Visitor& v, RotaryPlan& p) {
  const auto stations = [](std::string_view meaning) {
    return NumberSpec{.at_least = -90.0,
                      .at_most = 90.0,
                      .required = true,
                      .code = core::Code::kPoseRange,
                      .meaning = meaning};
  };
  v.list("balls", p.balls,
         {.required = true,
          .empty_allowed = false,
          .meaning = "At least 3, not on one line; better 4 or more, spread around the place where "
                     "parts are measured."});
  v.number(
      "ball_diameter_mm", p.ball_diameter_mm,
      range(1.0, 200.0, "Calibrated diameter of the balls; it is held while centres are fitted."));
  v.whole("points", p.points, range(5, 100, "Touches of each ball in each pose."));
  v.number("uncertainty_mm", p.uncertainty_mm,
           range(0.0, 50.0, "How far a ball may be from its nominal place."));
  v.numbers("alpha_stations_deg", p.alpha_stations_deg,
            stations("Angles of the base-fixed axis that are measured, the carried one at 0. The "
                     "zero pose is measured besides. Their ends are the range in which the "
                     "calibration holds."));
  v.numbers("beta_stations_deg", p.beta_stations_deg, stations("The same of the carried axis."));
  v.list("verification", p.verification,
         {.required = true,
          .empty_allowed = false,
          .meaning = "At least 5 poses of both axes that are measured but not used to find the "
                     "errors: what is left there is the figure of the calibration."});
  v.number("machine_uncertainty_um", p.machine_uncertainty_um,
           range(0.0, 1000.0,
                 "Standard uncertainty of a ball centre from the machine, beside the scatter "
                 "of the touches."));
  v.number("valid_for_days", p.valid_for_days,
           above(0.0, 36'500.0, "How long other runs may use the calibration."));
}

template <class Visitor>
void describe(Visitor& v, CalibrationPlan& p) {
  v.text("file", p.file,
         {.required = true,
          .empty_allowed = false,
          .meaning = "fixture-calibration.json of a run that calibrated this fixture, relative to "
                     "the plan."});
  v.number("max_age_days", p.max_age_days,
           range(0.0, 36'500.0, "An older one is refused, whatever it says of itself."));
  v.number("max_residual_um", p.max_residual_um,
           above(0.0, 10'000.0, "One that left more at a combined pose is refused."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedMotionPlan& p) {
  v.number("offset_um", p.offset_um,
           range(0.0, 10'000.0,
                 "How far each axis stands beside its stated place, in a drawn direction."));
  v.number("tilt_urad", p.tilt_urad, range(0.0, 10'000.0, "How far each axis is tilted."));
  v.number("shift_um", p.shift_um,
           range(0.0, 10'000.0, "Amplitude of the shifts that depend on the angle beyond that."));
  v.number("turn_urad", p.turn_urad, range(0.0, 10'000.0, "The same of the turns."));
  v.whole(
      "seed", p.seed,
      range(0, 9007199254740991.0, "Of the draw: one seed, one fixture. --seed leaves it alone."));
}

}  // namespace rondure::plans
