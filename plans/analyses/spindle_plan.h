#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace rondure::plans {

// The keys of a feature of the type "spindle" and of its simulation, as the JSON spells them; see
// plan.h. Keys and meanings: spindle_table.h.

struct SpindlePlan {
  std::string layout = "angles";  ///< "angles", "published-a", "published-b", "reference".
  std::optional<double> p1_to_p2_deg;
  std::optional<double> p2_to_p3_deg;  ///< One of these two.
  std::optional<double> p1_to_p3_deg;
  double crank_radius_mm = 0.0;  ///< 0: an ordinary shaft; else the arm follows a crank pin.
  double wheel_radius_mm = 0.0;
  double pin_radius_mm = 0.0;
  int samples = 1024;
  int highest_order = 50;
  double greatest_gain = 100.0;
  std::string recovery = "threshold";    ///< "threshold", "regularised".
  double expected_amplitude_um = 0.1;    ///< Of a harmonic, for "regularised".
  std::optional<double> probe_noise_um;  ///< None: estimated from the readings.
  std::string resampling = "on";         ///< "on", "off".
  std::string second_order = "auto";     ///< "auto", "on", "off".
  std::string motion = "least-squares";  ///< "least-squares", "as-published".
  std::string filter = "gaussian";       ///< Of the profile: "none", "gaussian".
  double cutoff_upr = 50.0;
};

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
  std::array<double, 3> probe_gain_error = {0.0, 0.0, 0.0};  ///< Relative.
  double p2_error_deg = 0.0;                                 ///< Real minus stated place of P2, P3.
  double p3_error_deg = 0.0;
};

}  // namespace rondure::plans
