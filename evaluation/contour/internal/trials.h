#pragma once

#include <span>
#include <vector>

#include "evaluation/contour/result.h"

// Trials of the values of a contour.

namespace rondure::evaluation {

/// Intervals of characteristics, all from t, in their order. That of f: following_interval().
[[nodiscard]] std::vector<UncertaintyStatus> total_intervals(
    const ContourResult& facts, std::span<const record::Characteristic> asked,
    const UncertaintyOptions& options);

/// Interval of the peak to valley of the mean f.
[[nodiscard]] UncertaintyStatus following_interval(const ContourResult& facts,
                                                   const UncertaintyOptions& options);

/// Interval of the gain: by how much the greatest peak to valley of the parts falls when
/// `change_mm` is added to their contours. The trials stand for the true contours, turned by the
/// zero of the gauge; the noise that is left in them makes a small contour larger, and so the gain
/// smaller, which is not taken out.
/// @param change_mm  One curve for each part, at the angles of its contour.
[[nodiscard]] UncertaintyStatus gain_interval(const ContourResult& facts,
                                              std::span<const std::vector<double>> change_mm,
                                              const UncertaintyOptions& options);

/// Standard uncertainty of the mean f of the parts at the angles of the contours [mm]: errors of
/// the encoders in full, which no trace shows, noise and skew of the traces. Or why it is not
/// known.
[[nodiscard]] core::Result<std::vector<double>> mean_following_u(const ContourResult& facts,
                                                                 const UncertaintyOptions& options);

}  // namespace rondure::evaluation
