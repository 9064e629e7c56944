#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rondure::plans {

// The keys of a feature of the type "rotary_axes" and of its simulation, named as in the JSON; see
// plan.h. Keys and meanings: rotary_table.h.

/// One ball of the artefact.
struct BallPlan {
  std::string id;
  std::array<double, 3> center_mm = {0.0, 0.0, 0.0};  ///< Nominal, body frame.
};

struct CombinedPosePlan {
  double alpha_deg = 0.0;
  double beta_deg = 0.0;
};

/// Calibration of the fixture with balls that it carries.
struct RotaryPlan {
  std::vector<BallPlan> balls;
  double ball_diameter_mm = 10.0;  ///< Calibrated; held constant while centres are fitted.
  int points = 9;                  ///< Touches of each ball in each pose.
  double uncertainty_mm = 0.5;     ///< Largest distance of a ball from its nominal place.
  std::vector<double> alpha_stations_deg;
  std::vector<double> beta_stations_deg;
  std::vector<CombinedPosePlan> verification;  ///< Poses that the fit does not use.
  /// Standard uncertainty of a centre, in addition to the touches.
  double machine_uncertainty_um = 0.0;
  double valid_for_days = 365.0;
};

/// The hidden errors of a simulated fixture, drawn at random: fixture/drawn_motion.h.
struct SimulatedMotionPlan {
  double offset_um = 25.0;
  double tilt_urad = 120.0;
  double shift_um = 3.0;
  double turn_urad = 15.0;
  std::uint64_t seed = 1;
};

/// The calibration that a run uses.
struct CalibrationPlan {
  std::string file;
  std::optional<double> max_age_days;
  std::optional<double> max_residual_um;
};

}  // namespace rondure::plans
