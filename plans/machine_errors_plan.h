#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/tasks/axis_errors.h"

namespace rondure::plans {

// simulation.machine and the marks of simulation.part, named as in the JSON. See plan.h.

struct PretravelLobePlan {
  int order = 3;
  double amplitude_um = 0.0;
  double phase_deg = 0.0;
};

/// Hidden errors of the machine. A given value replaces that of the class in `errors`.
struct SimulatedMachinePlan {
  enum class Errors { kOff, kTypical };

  Errors errors = Errors::kOff;
  std::vector<record::TranslationError> translations;
  std::vector<record::RotationError> rotations;
  std::optional<double> squareness_xy_urad;
  std::optional<double> squareness_xz_urad;
  std::optional<double> squareness_yz_urad;
  std::optional<double> tip_offset_x_mm;
  std::optional<double> tip_offset_y_mm;
  std::optional<double> tip_offset_z_mm;
  std::optional<double> pretravel_um;
  std::optional<double> pretravel_z_um;
  std::vector<PretravelLobePlan> pretravel_lobes;
  std::optional<double> stylus_length_mm;
  std::optional<double> stylus_diameter_mm;
  std::optional<double> stylus_modulus_GPa;
  std::optional<double> trigger_force_N;
  std::optional<double> backlash_x_um;
  std::optional<double> backlash_y_um;
  std::optional<double> backlash_z_um;
  std::optional<double> scale_expansion_per_K;
  std::optional<double> scale_temperature_degC;
  std::optional<double> drift_x_um;
  std::optional<double> drift_y_um;
  std::optional<double> drift_z_um;
  std::optional<double> drift_time_s;
  double scan_start_deg = 0.0;
  double scan_step_percent = 0.0;
  double scan_dropped_percent = 0.0;
};

RONDURE_WORDS(SimulatedMachinePlan::Errors, {kOff, "off"}, {kTypical, "typical"});

/// A slot along the part.
struct KeywayPlan {
  double at_deg = 0.0;
  double z_mm = 0.0;
  double width_mm = 6.0;
  double length_mm = 20.0;
  double depth_mm = 0.5;
};

/// A worn or ground spot, without edges.
struct FlatPlan {
  double at_deg = 0.0;
  double z_mm = 0.0;
  double width_mm = 5.0;
  double length_mm = 20.0;
  double depth_um = 20.0;
};

/// A raised spot.
struct BurrPlan {
  double at_deg = 0.0;
  double z_mm = 0.0;
  double width_mm = 1.0;
  double length_mm = 1.0;
  double height_um = 20.0;
};

}  // namespace rondure::plans
