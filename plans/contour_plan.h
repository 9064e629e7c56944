#pragma once

#include <string>
#include <vector>

#include "plans/spindle_plan.h"

namespace rondure::plans {

// The keys of a feature of the type "contour" and of its simulation, as the JSON spells them; see
// plan.h. Keys and meanings: contour_table.h.

/// Files of one ground part.
struct ContourPartPlan {
  std::string name;
  std::string axes;  ///< Trace of the controller.
  std::string pin;   ///< Contour of the pin from the gauge.
  std::string main;  ///< Contour of the neighbouring main journal; empty: none.
};

struct ContourPlan {
  double crank_radius_mm = 49.0;
  double wheel_radius_mm = 299.88;
  double pin_radius_mm = 24.56;
  double main_radius_mm = 30.0;
  std::string method = "corrected";            ///< "corrected", "as-published".
  std::string error = "actual-minus-command";  ///< Or "command-minus-actual".
  std::string c_axis = "with-wheel";           ///< Or "against-wheel".
  std::string gauge = "counter-clockwise";     ///< Or "clockwise".
  double phase_offset_deg = 0.0;
  double main_phase_offset_deg = 0.0;
  int samples = 1440;
  int path_samples = 1440;
  std::string filter = "gaussian";  ///< "gaussian", "none", "done-by-gauge".
  double cutoff_upr = 50.0;
  double pre_filter_upr = 0.0;
  std::string base_circle = "limacon";  ///< Or "geometric".
  std::string main_journal = "as-is";   ///< Or "mapped".
  double stable_from = 0.9;
  double partly_from = 0.5;
  std::vector<ContourPartPlan> parts;  ///< Empty: simulated.
};

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
  double c_noise_mdeg = 0.0;
  double x_noise_um = 0.0;
  double roughness_um = 0.0;  ///< Standard deviation of a gauge value.
  int gauge_points = 1440;
};

}  // namespace rondure::plans
