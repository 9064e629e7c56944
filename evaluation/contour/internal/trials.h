#pragma once

#include <span>
#include <vector>

#include "evaluation/contour/result.h"

// Trials of the values of a contour.

namespace rondure::evaluation {

/// Intervals of characteristics, all from t, in their order.
[[nodiscard]] std::vector<UncertaintyStatus> total_intervals(
    const ContourResult& facts, std::span<const record::Characteristic> asked,
    const UncertaintyOptions& options);

}  // namespace rondure::evaluation
