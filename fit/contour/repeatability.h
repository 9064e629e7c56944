#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/result.h"
#include "core/words.h"

namespace rondure::fit {

/// Verdict on how well a curve repeats from part to part.
enum class StabilityWord { kStable, kPartly, kUnstable };
RONDURE_WORDS(StabilityWord, {kStable, "stable"}, {kPartly, "partly"}, {kUnstable, "unstable"});

/// Least index of "stable" and of "partly".
inline constexpr double kStableFrom = 0.9;
inline constexpr double kPartlyFrom = 0.5;

/// The same curve of several parts, side by side.
struct Repeatability {
  std::vector<double> mean_curve;  ///< Mean over the parts, in the unit of the curves.
  double mean_rms = 0.0;           ///< A: rms of the mean curve.
  double spread = 0.0;             ///< s: standard deviation of the parts from the mean curve.
  /// S = (A^2 - s^2/q) / (A^2 - s^2/q + s^2): 1 for perfect repetition, 0 for random curves. A
  /// negative estimate is kept. Absent if all curves are zero.
  std::optional<double> index;
  /// Lower end of the interval of the index. Where it is known, the word "stable" goes by it.
  std::optional<double> index_low;
  bool no_word = false;  ///< The curves, or their index, are not known well enough for a word.
  std::vector<double> peak_to_valley;  ///< One per part.
  std::vector<double> rms;             ///< One per part.
  double variation = 0.0;       ///< Standard deviation / mean of the peak to valley; 0 for mean 0.
  Eigen::MatrixXd correlation;  ///< Correlation of all pairs of parts, q x q.
  double mean_correlation = 0.0;   ///< Mean over the pairs.
  double least_correlation = 0.0;  ///< Least of the pairs.

  /// The verdict; nothing with fewer than 4 parts, without an index, and where `no_word`. An index
  /// that reaches "stable" while the lower end of its interval does not is "partly".
  [[nodiscard]] std::optional<StabilityWord> word() const;
};

/// Compares q >= 2 curves of M >= 16 values each, one per part.
///
/// @return kTooFewPoints (fewer than 2 curves, or 16 values), kMeaning (different lengths).
/// Source: methods, contour section 8.
[[nodiscard]] core::Result<Repeatability> repeatability(
    std::span<const std::vector<double>> curves);

}  // namespace rondure::fit
