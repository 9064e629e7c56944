#pragma once

namespace rondure::cmm {

/// Hidden errors of a simulated machine and probe. All zero: ideal.
struct MachineErrors {
  double repeatability_mm = 0.0;  ///< Standard deviation of a touch along its approach direction.
  double tip_radius_error_mm = 0.0;  ///< Effective radius minus nominal (pre-travel included).
};

}  // namespace rondure::cmm
