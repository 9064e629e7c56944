#pragma once

#include <vector>

namespace rondure::plans {

// The keys of the simulation of a feature of the type "wheel", named as in the JSON; see plan.h.
// Keys and meanings: wheel_table.h. The keys of the feature itself: record/tasks/wheel.h.

struct WheelLobePlan {
  int order = 2;
  double amplitude_um = 0.0;
  double phase_deg = 0.0;
};

/// Hidden truth of a simulated wheel.
struct SimulatedWheelPlan {
  double radius_mm = 0.0;
  double axis_x_mm = 0.0;
  double axis_z_mm = 0.0;
  double eccentricity_um = 0.0;  ///< Eccentricity of the profile's centre from the axis.
  double eccentricity_deg = 0.0;
  std::vector<WheelLobePlan> lobes;  ///< amplitude cos(order theta - phase).
  double noise_um = 0.0;
  int points = 12;
  double arc_from_deg = 0.0;
  double arc_to_deg = 360.0;
  int chipped_point = 0;  ///< Number of the point in the middle of the chip, from 1; 0: none.
  double chip_um = 0.0;   ///< > 0: a proud grain.
  double chip_width_deg = 1.0;
};

}  // namespace rondure::plans
