#pragma once

#include <optional>
#include <vector>

#include "core/result.h"
#include "fit/profiles/closed_profile.h"

namespace rondure::fit {

/// One undulation number of a profile: amplitude_mm * cos(number theta - phase_rad).
struct Harmonic {
  int number = 1;  ///< Undulations per revolution; 1 is eccentricity.
  double amplitude_mm = 0.0;
  /// In (-pi, pi]; absent if the amplitude is below 3 times its standard uncertainty.
  std::optional<double> phase_rad;

  /// Angle of the first crest [rad]: phase / number.
  [[nodiscard]] std::optional<double> crest_rad() const;
};

/// Mean and harmonics 1..K.
struct HarmonicTable {
  double mean_mm = 0.0;
  std::vector<Harmonic> harmonics;
  double amplitude_sigma_mm = 0.0;  ///< Standard uncertainty of an amplitude: noise sqrt(2/N).
};

/// Settings of the harmonic analysis.
struct HarmonicOptions {
  int highest = 50;                ///< K >= 1.
  double noise_mm = 0.0;           ///< Standard deviation of one value [mm], >= 0.
  bool override_sampling = false;  ///< Allow K above n/7.
};

/// Computes the harmonics of a profile at uniform angles from its spectrum. Phases count from angle
/// 0, whatever the start angle.
/// @return kBadOption for K < 1, or K above (n - 1)/2, which n points cannot determine; kSampling
///         for K above n/7, where aliased undulations have wrong phases, unless overridden.
/// Source: methods, roundness B.6.
[[nodiscard]] core::Result<HarmonicTable> harmonics(const UniformProfile& profile,
                                                    const HarmonicOptions& options);

/// Computes the harmonics of a profile at any angles by least squares. Exact if the profile holds
/// no higher harmonic.
/// @return as harmonics(); kNotFullSection for a gap of 90 deg or more, as an arc has no harmonics;
///         kSampling for a gap of half an undulation of the highest harmonic. O(n K^2).
[[nodiscard]] core::Result<HarmonicTable> harmonic_fit(const AngularProfile& profile,
                                                       const HarmonicOptions& options);

/// The sum of mean and harmonics at uniform angles from 0. @pre samples above twice the number of
/// the highest harmonic. O(samples log samples).
[[nodiscard]] UniformProfile profile_of(const HarmonicTable& table, std::size_t samples);

}  // namespace rondure::fit
