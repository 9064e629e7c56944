#pragma once

#include <array>
#include <vector>

namespace rondure::plans {

// The keys of the simulation of a feature of the type "spindle", named as in the JSON; see plan.h.
// Keys and meanings: spindle_table.h. The keys of the feature itself: record/tasks/spindle.h.

struct HarmonicPlan {
  int order = 2;
  double amplitude_um = 0.0;
  double phase_deg = 0.0;
};

/// Hidden truth of a simulated spindle.
struct SimulatedSpindlePlan {
  int turns = 3;
  int samples_per_turn = 1024;         ///< Equal steps of the work angle.
  std::vector<HarmonicPlan> profile;   ///< amplitude cos(order theta - phase).
  std::vector<HarmonicPlan> motion_x;  ///< amplitude cos(order alpha - phase).
  std::vector<HarmonicPlan> motion_y;
  double asynchronous_um = 0.0;  ///< Amplitude of a motion of 0.37 cycles per turn, X and Y.
  double eccentricity_um = 0.0;
  double eccentricity_deg = 0.0;
  double probe_noise_um = 0.0;
  std::array<double, 3> probe_offset_um = {0.0, 0.0, 0.0};
  std::array<double, 3> probe_gain_error = {0.0, 0.0, 0.0};  ///< Relative error of the gain.
  double p2_error_deg = 0.0;  ///< Real minus stated angle of P2; the next member, of P3.
  double p3_error_deg = 0.0;
};

}  // namespace rondure::plans
