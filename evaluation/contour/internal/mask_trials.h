#pragma once

#include <span>
#include <vector>

#include "evaluation/contour/internal/contour_trials.h"
#include "evaluation/contour/internal/curves.h"
#include "evaluation/results/analysis_value.h"

// A mask on the harmonics of t: the lines that bind, and the interval of all of them together.

namespace rondure::evaluation::contour_trials {

/// The greatest share of a limit that any harmonic of any part takes, and that limit.
struct MaskShare {
  double share = 0.0;
  double limit_mm = 0.0;
};

MaskShare worst_share(const Curves& curves, const std::vector<record::HarmonicLimit>& mask);

/// The amplitudes of a mask that bind, each brought to the limit of the worst.
std::vector<Asked> mask_lines(const record::Characteristic& asked, const ContourTrials& trials);

/// The interval of a mask from those of its lines.
UncertaintyStatus of_mask_lines(const UncertaintyStatus& greatest,
                                std::span<const UncertaintyStatus> lines);

/// Whether the harmonic that decides is among those of the trials: the value is that of all
/// harmonics of the mask.
bool is_nearest(const MaskShare& worst, const core::Result<AnalysisValue>& measured);

}  // namespace rondure::evaluation::contour_trials
