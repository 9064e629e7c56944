#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/result.h"

namespace rondure::fit {

/// A closed profile at uniform angles: r_mm[i] belongs to start_rad + 2 pi i / N.
struct UniformProfile {
  double start_rad = 0.0;
  std::vector<double> r_mm;  ///< Radii, or their deviations from a constant [mm].

  [[nodiscard]] double angle_rad(std::size_t i) const;
};

/// A profile at any angles, sorted by angle.
struct AngularProfile {
  std::vector<double> theta_rad;  ///< Strictly ascending, in [0, 2 pi).
  std::vector<double> r_mm;       ///< Mean of the values at that angle [mm].
  std::vector<std::size_t> rows;  ///< Input row of each (the first if several were merged).
  std::size_t merged = 0;         ///< Values that shared an angle (1e-9 rad) with another value.
  std::size_t reversals = 0;      ///< Steps against the prevailing direction of the input.
  double turns = 0.0;             ///< Revolutions of the input.
  /// Largest gap between neighbours, including the last and the first.
  double largest_gap_rad = 0.0;

  /// Equal steps to 1e-6 of a step: no interpolation is needed.
  [[nodiscard]] bool uniform() const;
};

/// Sorts a profile by angle modulo one turn and merges values that share an angle.
///
/// @return kNoPoints (also for spans of different length), kNotFinite (row), kTooFewPoints (fewer
///         than 4 different angles).
[[nodiscard]] core::Result<AngularProfile> ordered_profile(std::span<const double> theta_rad,
                                                           std::span<const double> r_mm);

/// Checks that no gap of a profile at uneven angles hides undulations up to a cut-off: each must be
/// below a quarter of an undulation.
/// @return kSampling.
[[nodiscard]] core::Result<void> check_gaps(const AngularProfile& profile, double cutoff_upr);

/// Returns the angle that each point represents [rad]: half the gaps to its neighbours. A gap of
/// 90 deg or more is not part of the profile: the point beside it takes its inner half gap twice.
/// @param theta_rad  Ascending, within one turn; equal angles share their cell.
[[nodiscard]] std::vector<double> angular_cells(std::span<const double> theta_rad);

/// A profile at uniform angles, and the error of the resampling.
struct ResampledProfile {
  UniformProfile profile;
  bool interpolated = false;  ///< false: the angles were uniform, the values are the input's.
  /// Estimated interpolation error before the filter [mm]: the greatest difference from the spline
  /// through every other point, divided by 4. The error falls with the fourth power of the largest
  /// gap; omitting every other point widens the gap 2 times for uniform angles, 1.6 times for
  /// jittered ones.
  double error_mm = 0.0;
};

/// Brings a profile to uniform angles by a periodic cubic spline through all points.
///
/// Uniform input is returned unchanged. Otherwise the number of samples is the least power of two
/// that is at least 1024 and twice the number of points. With gaps below 360/(4 fc) deg the error
/// within the pass band of a filter fc is small: 2e-8 mm for a profile of 12e-3 mm at 720 points
/// with 35 % jitter and fc = 50 (docs/filters.md).
///
/// @return kNotFullSection if a gap of 90 deg or more would have to be bridged.
/// Source: methods, roundness B.1.
[[nodiscard]] core::Result<ResampledProfile> resampled(const AngularProfile& profile);

}  // namespace rondure::fit
