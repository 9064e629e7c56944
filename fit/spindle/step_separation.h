#pragma once

#include <span>
#include <vector>

#include "core/result.h"
#include "fit/profiles/closed_profile.h"
#include "fit/spindle/three_probe.h"

namespace rondure::fit {

/// Part and motion in the direction of one probe, found by turning the part against the spindle.
struct StepSeparation {
  UniformProfile part;            ///< Profile without harmonics 0 and 1.
  std::vector<double> motion_mm;  ///< Motion in the direction of the probe, same samples.
  std::vector<RecoveredHarmonic> harmonics;  ///< 2..highest; `transfer` is 1/gain.
  std::vector<int> unrecovered;  ///< Harmonics not separated; they remain in the motion.
};

/// Settings of both separations.
struct StepOptions {
  int highest = 50;              ///< >= 2 and below N/2.
  double noise_mm = 0.0;         ///< Standard deviation of a reading, for the uncertainties.
  double greatest_gain = 100.0;  ///< Harmonics above it are listed, not recovered.
};

/// Multi-step separation with one probe. The part is turned against the spindle by known angles,
///
///     m_j(phi) = r(phi + step_j) + S(phi).
///
/// Each harmonic is solved for r and S by least squares over the steps. With M equal steps of a
/// turn, multiples of M are the same in every trace and cannot be recovered.
///
/// @param steps_rad  Angle of the part relative to the first mounting, one per trace; at least 2.
/// @param traces_mm  N readings each, uniform in the spindle angle, starting at the same angle.
/// @return kSampling (counts, lengths, N < 2 highest + 2), kNotFinite, kBadOption, kRank (all steps
///         equal). O(M N log N).
/// Source: D. J. Whitehouse, J. Phys. E 9 (1976) 531 (multi-step method).
[[nodiscard]] core::Result<StepSeparation> separate_multi_step(
    std::span<const double> steps_rad, std::span<const std::vector<double>> traces_mm,
    const StepOptions& options = {});

/// Donaldson's reversal: part and probe are turned by 180 deg against the spindle between the two
/// traces, so that the motion changes its sign and the part does not:
///
///     first = r + S,   reversed = r - S.
///
/// Every harmonic is recovered with the gain 1/sqrt(2).
/// @return as separate_multi_step(). O(N log N).
/// Source: R. R. Donaldson, CIRP Annals 21(1), 1972 (simple method).
[[nodiscard]] core::Result<StepSeparation> separate_reversal(std::span<const double> first_mm,
                                                             std::span<const double> reversed_mm,
                                                             const StepOptions& options = {});

}  // namespace rondure::fit
