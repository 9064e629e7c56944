#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rondure::plans {

// The keys of the simulated errors that a feature of the type "rotary_axes" finds, and of the
// calibration that other runs use, as the JSON spells them; see plan.h. Keys and meanings:
// rotary_table.h.

/// The hidden errors of a simulated fixture, drawn at random: fixture/drawn_motion.h.
struct SimulatedMotionPlan {
  double offset_um = 25.0;
  double tilt_urad = 120.0;
  double shift_um = 3.0;
  double turn_urad = 15.0;
  std::uint64_t seed = 1;
};

/// The calibration that a run uses: of a file, or of one of its own features.
struct CalibrationPlan {
  std::string file;
  std::string feature;  ///< Its id; those before it are measured in the nominal fixture.
  std::optional<double> max_age_days;
  std::optional<double> max_residual_um;
};

}  // namespace rondure::plans
