#pragma once

#include <string>
#include <vector>

namespace rondure::plans {

// The keys of the simulation of a feature of the type "five_axis", as the JSON spells them; see
// plan.h. Keys and meanings: five_axis_table.h.

/// Location errors as planted. Those that the fit defines differ on an arc.
struct HeadLocationPlan {
  double XOC_um = 0.0;
  double YOC_um = 0.0;
  double AOC_urad = 0.0;
  double BOC_urad = 0.0;
  double YOA_um = 0.0;
  double ZOA_um = 0.0;
  double BOA_urad = 0.0;
  double COA_urad = 0.0;
};

/// A motion error: amplitude (cos(order phi - phase) - cos(phase)).
struct HeadMotionPlan {
  std::string error;
  int order = 1;
  double amplitude_um = 0.0;    ///< Of EX, EY, EZ.
  double amplitude_urad = 0.0;  ///< Of EA, EB, EC.
  double phase_deg = 0.0;
};

/// Hidden truth of a simulated head.
struct SimulatedFiveAxisPlan {
  HeadLocationPlan location;
  std::vector<HeadMotionPlan> errors;
  double sag_urad = 0.0;            ///< EAC that goes with sin A sin C.
  double xy_squareness_urad = 0.0;  ///< Of the slides.
  double noise_um = 0.0;            ///< Of one coordinate of a reading.
  double drift_um = 0.0;            ///< Of the nest along x, from the first reading to the last.
};

}  // namespace rondure::plans
