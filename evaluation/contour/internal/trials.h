#pragma once

#include <span>
#include <vector>

#include "evaluation/contour/result.h"

// Trials of the values of a contour. A curve is drawn by its harmonics from 2 up to where the
// filter transmits 1 %: what lies above moves no value by more than that share of the noise.

namespace rondure::evaluation {

/// Intervals of characteristics, all from t, in their order.
[[nodiscard]] std::vector<UncertaintyStatus> total_intervals(
    const ContourResult& facts, std::span<const record::Characteristic> asked,
    const UncertaintyOptions& options);

}  // namespace rondure::evaluation
