#pragma once

#include <span>
#include <string>

#include "evaluation/rotary/result.h"

// Drawings and tables of rotary axes, of a fixture or of a head.

namespace rondure::reports {

/// The six errors of one axis with their band, the stations, and the hidden truth where there is
/// one.
[[nodiscard]] std::string axis_charts(const evaluation::AxisFacts& axis,
                                      const record::Series* truth);
/// @param first, second  Names of the two axes of a pose.
[[nodiscard]] std::string combined_table(std::span<const evaluation::CombinedPose> poses,
                                         const char* first, const char* second);
/// What compensation is worth: the balls in poses that the fit did not use, before and after it.
[[nodiscard]] std::string residual_chart(std::span<const evaluation::CombinedPose> poses);
[[nodiscard]] std::string words_of_rotary();

}  // namespace rondure::reports
