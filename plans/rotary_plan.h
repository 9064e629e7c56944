#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "plans/key_spec.h"

namespace rondure::plans {

// The keys of the simulated errors that a feature of the type "rotary_axes" finds, and of the
// calibration that other runs use, as the JSON spells them; see plan.h.

/// The hidden errors of a simulated fixture, drawn at random: fixture/simulated.h.
struct SimulatedMotionPlan {
  double offset_um = 25.0;
  double tilt_urad = 120.0;
  double shift_um = 3.0;
  double turn_urad = 15.0;
  std::uint64_t seed = 1;
};

/// The calibration that a run uses: of a file, or of one of its own features.
struct CalibrationPlan {
  std::string file;
  std::string feature;  ///< Its id; those before it are measured in the nominal fixture.
  std::optional<double> max_age_days;
  std::optional<double> max_residual_um;
};

// Keys and meanings of features of the type "rotary_axes", of the simulated errors that
// they determine, and for the calibration that other runs use.

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
