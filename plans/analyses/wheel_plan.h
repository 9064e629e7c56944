#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rondure::plans {

// The keys of a feature of the type "wheel" and of its simulation, as the JSON spells them; see
// plan.h. Keys and meanings: wheel_table.h.

/// The surface that the wheel is to grind, and the generation of its path.
struct GroundSurfacePlan {
  std::string form = "polynomial";  ///< "polynomial", "asphere", "table".
  std::vector<double> coefficients;
  std::optional<double> vertex_radius_mm;
  double conic = 0.0;
  std::vector<double> even_terms;
  std::vector<double> table_x_mm;
  std::vector<double> table_z_mm;
  std::vector<double> removal_x_mm;
  std::vector<double> removal_depth_um;
  double from_mm = 0.0;
  double to_mm = 0.0;
  double step_mm = 0.1;
  std::optional<double> cusp_um;  ///< Given instead of the step.
  std::string radius = "mean";    ///< "mean", "effective".
  double wheel_arc_from_deg = -90.0;
  double wheel_arc_to_deg = 90.0;
  double repeatability_um = 0.0;
  std::optional<double> touch_off_mm;
};

struct WheelPlan {
  std::string mode;  ///< "indexed", "envelope".
  std::optional<double> nominal_radius_mm;
  std::optional<double> axis_x_mm;  ///< Both or none.
  std::optional<double> axis_z_mm;
  std::string center = "least-squares";  ///< "least-squares", "as-published", "weighted".
  std::string quadruples = "all";        ///< "all", "best", "random".
  int count = 6;
  std::optional<double> kappa_limit;
  std::string robust = "off";         ///< "off", "on".
  std::string short_arc = "refused";  ///< "refused", "allowed".
  std::optional<GroundSurfacePlan> surface;
};

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
  double eccentricity_um = 0.0;  ///< Of the profile's centre from the axis.
  double eccentricity_deg = 0.0;
  std::vector<WheelLobePlan> lobes;  ///< amplitude cos(order theta - phase).
  double noise_um = 0.0;
  int points = 12;
  double arc_from_deg = 0.0;
  double arc_to_deg = 360.0;
  int chipped_point = 0;  ///< From 1; 0: none.
  double chip_um = 0.0;
};

}  // namespace rondure::plans
