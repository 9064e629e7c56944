#pragma once

#include <cstddef>
#include <cstdint>

#include "plans/analyses/analysis.h"

namespace rondure::plans {

/// Simulated pins of a contour feature: traces of the controller, pins as the envelope of all wheel
/// positions with their non-following part, and main journals with that part alone.
/// @return The data, or the errors of wheel_path().
[[nodiscard]] core::Result<AnalysisData> simulate_contour(const Plan& plan, std::size_t index,
                                                          std::uint64_t seed, bool errors);

}  // namespace rondure::plans
