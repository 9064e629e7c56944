#pragma once

#include <span>
#include <vector>

#include "core/result.h"

namespace rondure::fit {

/// What the Gaussian filter of an open profile does where its weight reaches beyond an end.
enum class OpenEnds {
  /// Local straight line (moments 0 and 1 retained, ISO 16610-28): a slope runs on to the end.
  /// Inside
  /// it is the filter of ISO 16610-21, 50 % at the cut-off. Nothing is lost.
  kLine,
  /// Local parabola (moments 0 to 2 retained): curvature runs on too. The weight is wider
  /// (constant 0.7309 in place of 0.4697), so that the transmission is 50 % at the cut-off here
  /// also.
  kParabola,
  /// The weight is cut off and scaled to sum 1; half a cut-off at both ends is left out.
  kDiscard,
};

/// Settings of filter_open().
struct OpenFilterOptions {
  double cutoff = 0.8;  ///< Wavelength in the unit of the positions; > 0.
  OpenEnds ends = OpenEnds::kLine;
  bool override_sampling = false;  ///< Filter also with fewer than 7 points per cut-off.
};

/// Mean line of an open profile.
struct OpenProfile {
  std::vector<double> position;  ///< Where it is evaluated: the input's, less discarded ends.
  std::vector<double> r_mm;
  std::size_t first = 0;  ///< Input row of position[0].
  bool sampling_overridden = false;
};

/// Gaussian low pass of a profile with two ends, at any spacing: a straight generatrix (positions
/// in mm) or an arc (positions in rad; the cut-off is 2 pi / UPR). High pass: the input less this.
///
/// At every position a polynomial is fitted by least squares with the weights
/// exp(-pi ((x - x_i) / (alpha lambda))^2) times the length each point stands for; its value there
/// is the mean line.
///
/// @param position  n >= 3, strictly ascending.
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kBadOption (cut-off, positions not
/// ascending,
///         nothing left between discarded ends), kSampling (a gap above cut-off / 7). O(n) times
///         the points within four cut-offs.
/// Sources: ISO 16610-21, ISO 16610-28, ISO 16610-31 (constants); methods, roundness B.7.
[[nodiscard]] core::Result<OpenProfile> filter_open(std::span<const double> position,
                                                    std::span<const double> r_mm,
                                                    const OpenFilterOptions& options);

}  // namespace rondure::fit
