#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plans/spindle_plan.h"

namespace rondure::plans {

// The keys of the simulation of a feature of the type "contour", as the JSON spells them; see
// plan.h. Keys and meanings: contour_table.h.

struct AngleHarmonicPlan {
  int order = 1;
  double amplitude_mdeg = 0.0;
  double phase_deg = 0.0;
};

/// Hidden truth of simulated pins.
struct SimulatedContourPlan {
  int parts = 4;
  double speed_rpm = 50.0;
  double sampling_ms = 4.0;
  double turns = 1.5;
  std::vector<AngleHarmonicPlan> c_error;  ///< amplitude cos(order alpha - phase).
  std::vector<HarmonicPlan> x_error;
  double c_error_spread = 0.0;  ///< Standard deviation of the size of C errors from part to part.
  std::vector<HarmonicPlan>
      rest;  ///< Non-following harmonics of every part: amplitude cos(order beta - phase).
  double rest_spread_um = 0.0;  ///< Part-to-part variation of `rest`.
  /// What pin and main journal do not share, rms; none: half of the rms of what varies.
  std::optional<double> pin_own_um;
  std::optional<double> main_own_um;
  double c_noise_mdeg = 0.0;
  double x_noise_um = 0.0;
  double roughness_um = 0.0;  ///< Standard deviation of a gauge value.
  int gauge_points = 1440;
};

}  // namespace rondure::plans
