#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fit/profiles/internal/dft.h"
#include "fit/spindle/three_probe.h"

// The steps of separate_three_probe().

namespace rondure::fit {

/// Readings of whole revolutions on samples uniform in theta.
struct ProbeSamples {
  std::size_t count = 0;  ///< N: samples per revolution.
  int revolutions = 1;
  double start_rad = 0.0;  ///< theta of the first sample.
  std::size_t rows = 0;    ///< Readings from which the samples come.
  bool interpolated = false;
  std::array<std::vector<double>, 3> h_mm;     ///< count * revolutions values.
  std::array<std::vector<double>, 3> mean_mm;  ///< Mean revolution.
  std::vector<double> alpha_rad;               ///< Work angle in the first revolution.
  std::vector<double> beta_rad;
  std::vector<double> theta_rad;  ///< theta of every reading used.
  double largest_gap_rad = 0.0;   ///< Largest gap between neighbouring readings in theta.
};

/// A.6: checks, unwraps, interpolates and averages the readings.
/// @return the errors of separate_three_probe() that concern the readings.
[[nodiscard]] core::Result<ProbeSamples> sample_readings(const ProbeReadings& readings,
                                                         const SwingArm& arm,
                                                         const ThreeProbeOptions& options);

/// A.7: computes the motion of every revolution and its mean from the profile of the result and its
/// half spectrum, then removes eccentricity and probe zeros.
/// @param spectrum  Spectrum of the samples at theta - start.
void separate_motion(const ProbeSamples& samples, const Spectrum& spectrum,
                     const ThreeProbeOptions& options, ThreeProbeResult& result);

/// Half spectrum of r(theta + shift), or of its derivative of the given order.
[[nodiscard]] Spectrum shifted(const Spectrum& spectrum, double shift_rad, int derivative);

/// The matrix P of the least-squares solution (X, Y) = P m without swing, where m holds the three
/// readings minus the part.
[[nodiscard]] Eigen::Matrix<double, 2, 3> motion_solver(const std::array<double, 3>& angles_rad);
/// The same matrix after a swing, which turns all probes, and so the solution, by beta.
[[nodiscard]] Eigen::Matrix<double, 2, 3> swung(const Eigen::Matrix<double, 2, 3>& p,
                                                double beta_rad);

/// Removes the best c e^{j alpha} + c0 e^{-j beta} over the work angle (eccentricity, probe zeros)
/// from a motion.
void remove_eccentricity(std::span<const double> alpha_rad, std::span<const double> beta_rad,
                         CentreMotion& motion);

/// The mean motion with eccentricity, but without probe zeros. The zeros are removed as
/// c0 e^{-j beta}, with c0 from the mean over the work angle, to which no other synchronous motion
/// contributes. A constant displacement of the centre looks the same and is removed with them.
[[nodiscard]] CentreMotion motion_without_zeros(const ThreeProbeResult& result);

/// A.8: subtracts from each reading of the mean revolution the terms that the linear equations
/// neglect, given the present profile and motion. The readings of all revolutions change alike. The
/// motion is that of motion_without_zeros(), as a probe zero is not a displacement.
/// @return Largest correction [mm]; NaN if the motion is as large as the part.
double correct_second_order(const ProbeSamples& measured, const Spectrum& spectrum,
                            const ThreeProbeResult& result, double part_radius_mm,
                            ProbeSamples& samples);

/// Estimates the standard deviation of a reading from the spectrum of the weighted sum. With
/// several revolutions it follows from their scatter, which is free of part and motion; with one
/// revolution, from the median of the harmonics above the highest, which also contain the
/// undulations of a rough part.
/// @return Nothing if there is one revolution and no such harmonic.
[[nodiscard]] std::optional<double> estimated_noise_mm(const ProbeSamples& samples,
                                                       const Spectrum& sum,
                                                       const ProbeLayout& layout, int highest);

/// Standard deviation of a reading from the differences between the revolutions, for each harmonic
/// 2..highest of the weighted sum. Empty for a single revolution.
[[nodiscard]] std::vector<double> scatter_by_order_mm(const ProbeSamples& samples,
                                                      const ProbeLayout& layout, int highest);

/// Adds readings that contradict the stated geometry or are invalid to
/// ThreeProbeResult::contradictions.
void find_contradictions(const ProbeReadings& readings, const ProbeSamples& samples,
                         const SwingArm& arm, const ThreeProbeOptions& options,
                         ThreeProbeResult& result);

}  // namespace rondure::fit
