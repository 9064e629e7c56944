#pragma once

#include <span>
#include <vector>

#include "core/result.h"
#include "fit/profiles/closed_profile.h"

namespace rondure::fit {

/// Treatment of the ends of an open profile, where the weight function of the Gaussian filter
/// extends beyond the profile.
enum class OpenEnds {
  /// Local straight line (moments 0 and 1 retained, ISO 16610-28): follows a slope up to the end.
  /// In the interior it equals the filter of ISO 16610-21, 50 % at the cut-off. No length is lost.
  kLine,
  /// Local parabola (moments 0 to 2 retained): follows curvature as well. The weight function is
  /// wider (constant 0.7309 instead of 0.4697), so that 50 % is transmitted at the cut-off as well.
  kParabola,
  /// The weight function is truncated and scaled to sum 1; both ends lose half a cut-off.
  kDiscard,
};

/// Settings of filter_open().
struct OpenFilterOptions {
  double cutoff = 0.8;  ///< Wavelength in the unit of the positions; > 0.
  OpenEnds ends = OpenEnds::kLine;
  bool override_sampling = false;  ///< Filter also with fewer than 7 points per cut-off.
  /// Gaps above 1.5 times the median one are windows left out of the profile (keyway, oil hole):
  /// they do not count for the sampling, and a point beside one represents no more of it than half
  /// of 1.5 median gaps. Otherwise the two points would stand for the whole window.
  bool windows = false;
};

/// Mean line of an open profile.
struct OpenProfile {
  std::vector<double> position;  ///< Positions of the input without the discarded ends.
  std::vector<double> r_mm;
  std::size_t first = 0;             ///< Input row of position[0].
  bool sampling_overridden = false;  ///< Fewer than 7 points per cut-off, filtered by option.
};

/// Filters a profile with two ends and any spacing by a Gaussian low pass: a straight generatrix
/// (positions in mm) or an arc (positions in rad; the cut-off is 2 pi / UPR). The high pass is the
/// input minus this result.
///
/// At every position a polynomial is fitted by least squares, with the weights
/// exp(-pi ((x - x_i) / (alpha lambda))^2) times the length that each point represents. Its value
/// there is the mean line.
///
/// @param position  n >= 3, strictly ascending.
/// @return kNoPoints, kNotFinite (row), kTooFewPoints, kBadOption (cut-off, positions not
///         ascending, nothing left between discarded ends), kSampling (a gap above cut-off / 7).
///         O(n) times the points within four cut-offs.
/// Sources: ISO 16610-21, ISO 16610-28, ISO 16610-31 (constants); methods, roundness B.7.
[[nodiscard]] core::Result<OpenProfile> filter_open(std::span<const double> position,
                                                    std::span<const double> r_mm,
                                                    const OpenFilterOptions& options);

/// Filters a closed profile with windows left out, at any angles: the local line of filter_open()
/// on the circle, where the angles wrap; the cut-off is 2 pi / UPR. Without a window, at uniform
/// angles, it equals the Gaussian of filter_closed().
/// @return Values at the angles of the profile; kBadOption (cut-off), kSampling (a gap within the
///         profile above 2 pi / (7 UPR)). O(n) times the points within four cut-offs.
/// Source: methods, drawing section 7.
[[nodiscard]] core::Result<std::vector<double>> filter_with_windows(const AngularProfile& profile,
                                                                    double cutoff_upr);

}  // namespace rondure::fit
