#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/spindle/three_probe.h"

// Private to the room: the steps of separate_three_probe().

namespace rondure::fit {

/// Readings of whole revolutions on samples uniform in theta.
struct ProbeSamples {
  std::size_t count = 0;  ///< N of a revolution.
  int revolutions = 1;
  double start_rad = 0.0;  ///< theta of the first sample.
  std::size_t rows = 0;    ///< Readings behind them.
  bool interpolated = false;
  std::array<std::vector<double>, 3> h_mm;     ///< count * revolutions values.
  std::array<std::vector<double>, 3> mean_mm;  ///< Mean revolution.
  std::vector<double> alpha_rad;               ///< Of the first revolution.
  std::vector<double> beta_rad;
  std::vector<double> theta_rad;  ///< Of every reading used.
  double largest_gap_rad = 0.0;   ///< Between neighbouring readings in theta.
};

/// A.6: checks, unwraps, interpolates, averages.
[[nodiscard]] core::Result<ProbeSamples> sample_readings(const ProbeReadings& readings,
                                                         const SwingArm& arm,
                                                         const ThreeProbeOptions& options);

/// A.7: motion of every revolution and its mean from the profile of the result and its half
/// spectrum; then eccentricity and zeros are taken out. `spectrum` belongs to samples at theta -
/// start.
void separate_motion(const ProbeSamples& samples, const std::vector<std::complex<double>>& spectrum,
                     const ThreeProbeOptions& options, ThreeProbeResult& result);

/// The mean motion with eccentricity, without probe zeros: c0 e^{-j beta} with the mean over the
/// work angle, to which no other synchronous motion adds. A constant displacement of the centre
/// looks the same and goes with it.
[[nodiscard]] CentreMotion motion_without_zeros(const ThreeProbeResult& result);

/// A.8: subtracts from each reading of the mean revolution what the linear equations neglect, given
/// the present profile and motion; the readings of all revolutions move alike. The motion is that
/// of motion_without_zeros(): a probe zero displaces nothing.
/// @return Largest correction [mm]; NaN where the motion leaves none, being as large as the part.
double correct_second_order(const ProbeSamples& measured,
                            const std::vector<std::complex<double>>& spectrum,
                            const ThreeProbeResult& result, double part_radius_mm,
                            ProbeSamples& samples);

/// The standard deviation of a reading from the spectrum of the weighted sum: with several
/// revolutions from their scatter, which neither part nor motion enters; with one from the
/// median of the harmonics above the highest, which hold a rough part's undulations too. Nothing
/// where there is one revolution and no such harmonic.
[[nodiscard]] std::optional<double> estimated_noise_mm(const ProbeSamples& samples,
                                                       const std::vector<std::complex<double>>& sum,
                                                       const ProbeLayout& layout, int highest);

/// Adds what contradicts the stated geometry or is no reading of the surface: see
/// ThreeProbeResult::contradictions.
void find_contradictions(const ProbeReadings& readings, const ProbeSamples& samples,
                         const SwingArm& arm, const ThreeProbeOptions& options,
                         ThreeProbeResult& result);

}  // namespace rondure::fit
