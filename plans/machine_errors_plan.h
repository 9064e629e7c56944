#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "plans/key_spec.h"
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

// Keys and meanings of the hidden errors of the simulated machine and the marks on the
// simulated part.

template <class Visitor>
void describe(Visitor& v, PretravelLobePlan& p) {
  v.whole(
      "order", p.order,
      required(range(
          1, 50, "Lobes in a turn about the stylus; 3 for a probe that rests on three points.")));
  v.number("amplitude_um", p.amplitude_um, range(0.0, 1000.0, "Half of peak to valley."));
  v.number("phase_deg", p.phase_deg, within(360.0, "Phase for an approach toward +x."));
}

template <class Visitor>
void describe_probe(Visitor& v, SimulatedMachinePlan& p) {
  v.number("pretravel_um", p.pretravel_um,
           within(1000.0, "Travel from contact to trigger across the stylus: mean."));
  v.number("pretravel_z_um", p.pretravel_z_um, within(1000.0, "The same along the stylus."));
  v.list("pretravel_lobes", p.pretravel_lobes,
         {.meaning = "How the pre-travel changes with the direction of the approach."});
  v.number("stylus_length_mm", p.stylus_length_mm,
           range(0.0, 1000.0, "Length of the stylus that the trigger force bends; 0: rigid."));
  v.number("stylus_diameter_mm", p.stylus_diameter_mm,
           range(0.1, 50.0, "Diameter of its round shaft."));
  v.number("stylus_modulus_GPa", p.stylus_modulus_GPa,
           range(1.0, 1200.0, "Its modulus of elasticity: tungsten carbide 600, steel 210."));
  v.number("trigger_force_N", p.trigger_force_N, range(0.0, 10.0, "Force at the trigger."));
}

template <class Visitor>
void describe(Visitor& v, SimulatedMachinePlan& p) {
  v.text("errors", p.errors,
         {.meaning = "Errors that are not given: 0, or those of a good bridge machine."});
  v.list("translations", p.translations,
         {.meaning = "Position and straightness errors of the axes; each takes the place of the "
                     "one of its name."});
  v.list("rotations", p.rotations, {.meaning = "Roll, pitch and yaw of the axes, likewise."});
  constexpr std::string_view kSquare = "Departure of the angle between these axes from 90 deg.";
  v.number("squareness_xy_urad", p.squareness_xy_urad, within(10'000.0, kSquare));
  v.number("squareness_xz_urad", p.squareness_xz_urad, within(10'000.0, kSquare));
  v.number("squareness_yz_urad", p.squareness_yz_urad, within(10'000.0, kSquare));
  constexpr std::string_view kOffset =
      "From where the ram turns to the tip: the lever of its rotations.";
  v.number("tip_offset_x_mm", p.tip_offset_x_mm, within(2000.0, kOffset));
  v.number("tip_offset_y_mm", p.tip_offset_y_mm, within(2000.0, kOffset));
  v.number("tip_offset_z_mm", p.tip_offset_z_mm, within(2000.0, kOffset));
  describe_probe(v, p);
  constexpr std::string_view kBacklash =
      "Hysteresis: reading on approach in the positive direction minus in the negative.";
  v.number("backlash_x_um", p.backlash_x_um, within(1000.0, kBacklash));
  v.number("backlash_y_um", p.backlash_y_um, within(1000.0, kBacklash));
  v.number("backlash_z_um", p.backlash_z_um, within(1000.0, kBacklash));
  v.number("scale_expansion_per_K", p.scale_expansion_per_K,
           range(0.0, 1e-4, "Real expansion of the scales."));
  v.number("scale_temperature_degC", p.scale_temperature_degC,
           range(10.0, 40.0, "Temperature of the scales, real and as the machine reads it."));
  constexpr std::string_view kDrift = "Final drift of the reading of a fixed point.";
  v.number("drift_x_um", p.drift_x_um, within(1000.0, kDrift));
  v.number("drift_y_um", p.drift_y_um, within(1000.0, kDrift));
  v.number("drift_z_um", p.drift_z_um, within(1000.0, kDrift));
  v.number("drift_time_s", p.drift_time_s,
           range(1.0, 1e6, "Time constant of the drift: 63 % of it is done then."));
  v.number("scan_start_deg", p.scan_start_deg,
           range(0.0, 5.0, "Largest distance of the first point of a scan from its start."));
  v.number("scan_step_percent", p.scan_step_percent,
           range(0.0, 50.0, "Largest relative change of the steps of a scan."));
  v.number("scan_dropped_percent", p.scan_dropped_percent,
           range(0.0, 50.0, "Share of the points of a scan that are missing."));
}

template <class Visitor>
void describe(Visitor& v, KeywayPlan& p) {
  v.number("at_deg", p.at_deg, within(360.0, "Angle of its middle."));
  v.number("z_mm", p.z_mm, within(10'000.0, "Height of its middle, part z."));
  v.number("width_mm", p.width_mm, range(0.1, 500.0, "Along the circumference."));
  v.number("length_mm", p.length_mm, range(0.1, 10'000.0, "Along the part."));
  v.number("depth_mm", p.depth_mm, range(0.0, 50.0, "Its floor follows the surface."));
}

template <class Visitor>
void describe(Visitor& v, FlatPlan& p) {
  v.number("at_deg", p.at_deg, within(360.0, "Angle of its middle on the part."));
  v.number("z_mm", p.z_mm, within(10'000.0, "Height of its middle, part z."));
  v.number("width_mm", p.width_mm, range(0.01, 1000.0, "Along the circumference."));
  v.number("length_mm", p.length_mm, range(0.01, 10'000.0, "Along the axis."));
  v.number("depth_um", p.depth_um,
           range(0.0, 1000.0, "In its middle; from there the spot rises softly to its edges."));
}

template <class Visitor>
void describe(Visitor& v, BurrPlan& p) {
  v.number("at_deg", p.at_deg, within(360.0, "Angle of its middle."));
  v.number("z_mm", p.z_mm, within(10'000.0, "Height of its middle, part z."));
  v.number("width_mm", p.width_mm, range(0.05, 500.0, "Along the circumference."));
  v.number("length_mm", p.length_mm, range(0.05, 10'000.0, "Along the part."));
  v.number("height_um", p.height_um, range(0.0, 5000.0, "Above the surface."));
}

}  // namespace rondure::plans
