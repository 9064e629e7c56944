#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"

namespace rondure::evaluation {

/// Marks deviations d with |d - m| > 5 s, m = median d, s = 1.4826 median |d - m|, at least 0.1 um:
/// one bad point cannot widen its own limit. Same scales as fit/wheel/outliers.h.
/// @pre Not empty.
[[nodiscard]] std::vector<bool> beyond_five_scales(std::span<const double> deviations_mm);

/// Number of marked points; kOutliers when it is more than a quarter of all, since that is form.
[[nodiscard]] core::Result<std::size_t> count_of_outliers(const std::vector<bool>& out);

/// Most marked points that are next to each other round a closed profile.
/// @param out  By angle.
[[nodiscard]] std::size_t longest_run(const std::vector<bool>& out);

}  // namespace rondure::evaluation
