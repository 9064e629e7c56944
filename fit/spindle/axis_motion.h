#pragma once

#include <optional>
#include <span>
#include <vector>

namespace rondure::fit {

/// Error motion of an axis in one fixed direction, over all recorded revolutions.
struct AxisMotion {
  double total_mm = 0.0;        ///< Greatest minus least value of all revolutions.
  double synchronous_mm = 0.0;  ///< Greatest minus least value of the mean revolution.
  /// Greatest spread of the revolutions at one angle; none for a single revolution.
  std::optional<double> asynchronous_mm;
  double fundamental_mm = 0.0;  ///< Amplitude at one cycle per turn, removed from all revolutions.
  std::vector<double> mean_mm;  ///< The mean revolution about the centre of its polar plot.
  std::vector<std::vector<double>> turns_mm;  ///< Every revolution about that same centre.
};

/// The part of a turn of the work for which each sample of a turn stands; they add to 1. Samples
/// that are uniform on a tracked part are not uniform over the work.
/// @param alpha_rad  Work angle of each sample, increasing, N >= 3.
[[nodiscard]] std::vector<double> work_shares(std::span<const double> alpha_rad);

/// Computes the error motion values of ISO 230-7 from the polar plot of one direction. The centre
/// of the plot is that of the least-squares circle of the mean revolution over the work angle: a
/// constant and one cycle per turn are not error motion.
/// @param alpha_rad  Work angle of each sample of a revolution, N >= 4.
/// @param turns_mm   The revolutions, N values each; at least one. O(N revolutions).
/// Source: ISO 230-7:2015, 3.2 (error motion polar plot and values).
[[nodiscard]] AxisMotion axis_motion(std::span<const double> alpha_rad,
                                     std::span<const std::vector<double>> turns_mm);

}  // namespace rondure::fit
